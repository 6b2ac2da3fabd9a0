#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

/// One OPERATIONAL device and the frames that it has sent since the last check.
class Sender {
 public:
  explicit Sender(SampleDevice table) : device_{table.build(), Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    device_.on_time(device_.deadline());
    device_.on_frame(make_frame(CobId::base(0), {1, 5}), 100ms);
  }
  Device* operator->() { return &device_; }
  std::vector<Frame> take(CobId id) {
    std::vector<Frame> found;
    for (const Transmission& item : device_.out().pending()) {
      if (item.frame.id == id) found.push_back(item.frame);
    }
    device_.out().clear();
    return found;
  }
  /// Writes by SDO, which is an event for the PDOs.
  void write(std::initializer_list<std::uint8_t> bytes) {
    device_.on_frame(make_frame(CobId::base(0x605), bytes), 200ms);
  }
  void receive(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    device_.on_frame(make_frame(CobId::base(id), bytes), 200ms);
  }
  std::uint64_t get(std::uint16_t index) { return device_.objects().find({index, 0})->value; }

 private:
  Device device_;
};

/// Makes a device with a PDO whose mapping has the mark `count` in sub-index 0 and these entries.
SampleDevice multiplexed(std::uint16_t communication, std::uint32_t cob, std::uint8_t count,
                         std::vector<std::uint32_t> entries = {}) {
  SampleDevice device = communicating(5_node);
  using enum DataType;
  device.object(communication, 0, unsigned8, Access::constant, 2)
      .object(communication, 1, unsigned32, Access::rw, cob)
      .object(communication, 2, unsigned8, Access::rw, 255);
  const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
  device.object(mapping, 0, unsigned8, Access::rw, count);
  for (std::uint8_t sub = 1; sub <= entries.size(); ++sub) {
    device.object(mapping, sub, unsigned32, Access::rw, entries[sub - 1u]);
  }
  return device;
}

TEST(MultiplexedPdos, BySourceAreSentForEachScannedObjectThatChanges) {
  using enum DataType;
  Sender device{multiplexed(0x1800, 0x185, 0xFE)
                    .object(0x1FA0, 0, unsigned8, Access::constant, 2)
                    .object(0x1FA0, 1, unsigned32, Access::rw, 0x0120'1000)
                    .object(0x1FA0, 2, unsigned32, Access::rw, 0x0120'1200)};
  EXPECT_EQ(device.take(CobId::base(0x185)),
            (std::vector{make_frame(CobId::base(0x185), {0x05, 0x10, 0x20, 0, 0, 0, 0, 0}),
                         make_frame(CobId::base(0x185), {0x05, 0x12, 0x20, 0, 0, 0, 0, 0})}))
      << "its state on entering OPERATIONAL";

  device.write({0x23, 0x10, 0x20, 0x00, 0x78, 0x56, 0x34, 0x12});

  EXPECT_EQ(
      device.take(CobId::base(0x185)),
      (std::vector{make_frame(CobId::base(0x185), {0x05, 0x10, 0x20, 0, 0x78, 0x56, 0x34, 0x12})}));
}

TEST(MultiplexedPdos, ByDestinationWriteTheObjectOfTheNodeThatIsAddressed) {
  Sender device{multiplexed(0x1400, 0x305, 0xFF)};
  device.receive(0x305, {0x85, 0x10, 0x20, 0x00, 0x78, 0x56, 0x34, 0x12});
  EXPECT_EQ(device.get(0x2010), 0x12345678u);

  device.receive(0x305, {0x86, 0x10, 0x20, 0x00, 1, 0, 0, 0});
  EXPECT_EQ(device.get(0x2010), 0x12345678u) << "for node 6";
  device.receive(0x305, {0x80, 0x10, 0x20, 0x00, 1, 0, 0, 0});
  EXPECT_EQ(device.get(0x2010), 1u) << "for all";
}

TEST(MultiplexedPdos, ForAnObjectThatDoesNotExistAreReported) {
  Sender device{multiplexed(0x1400, 0x305, 0xFF)};
  device.take(CobId::base(0x085));
  device.receive(0x305, {0x85, 0x00, 0x30, 0x01, 0, 0, 0, 0});
  EXPECT_EQ(device.take(CobId::base(0x085)),
            (std::vector{make_frame(CobId::base(0x085), {0x30, 0x82, 0x11, 1, 0, 0, 0, 0})}));
}

// node 7's 6041:00 -> local 2012:00
TEST(MultiplexedPdos, BySourceAreTakenAsTheDispatcherListSays) {
  using enum DataType;
  Sender device{multiplexed(0x1400, 0x187, 0xFE)
                    .object(0x1FD0, 0, unsigned8, Access::constant, 1)
                    .object(0x1FD0, 1, unsigned64, Access::rw, 0x0120'1200'6041'0007)};
  device.receive(0x187, {0x07, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0});
  EXPECT_EQ(device.get(0x2012), 0x0237u);

  device.receive(0x187, {0x08, 0x41, 0x60, 0x00, 0x50, 0x02, 0, 0});
  device.receive(0x187, {0x07, 0x40, 0x60, 0x00, 0x50, 0x02, 0, 0});
  EXPECT_EQ(device.get(0x2012), 0x0237u) << "another node, another object";
}

TEST(Device, AnswersASyncWithAllOf512Tpdos) {
  SampleDevice table = communicating(5_node);
  using enum DataType;
  for (std::uint16_t i = 0; i < 512; ++i) {
    const auto communication = static_cast<std::uint16_t>(0x1800 + i);
    table.object(communication, 0, unsigned8, Access::constant, 2)
        .object(communication, 1, unsigned32, Access::rw, 0x2001'0000u + i)
        .object(communication, 2, unsigned8, Access::rw, 1)
        .object(static_cast<std::uint16_t>(communication + 0x200), 0, unsigned8, Access::rw, 1)
        .object(static_cast<std::uint16_t>(communication + 0x200), 1, unsigned32, Access::rw,
                0x2011'0020);
  }
  Sender device{table};
  device->out().clear();

  device->on_frame({.id = CobId::base(0x080)}, 101ms);

  ASSERT_EQ(device->out().pending().size(), 512u);
  EXPECT_EQ(device->out().pending()[511].frame.id, CobId::extended(0x101FF));
}

TEST(Tpdo, OfARemoteTypeMustAllowRemoteRequests) {
  Sender device{communicating(5_node).pdo(0x1800, 0x8000'0185, 253, {0x20110020})};
  device->out().clear();
  device.write({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0x40});
  device.write({0x40, 0x00, 0x18, 0x01, 0, 0, 0, 0});
  EXPECT_EQ(device->objects().find({0x1800, 1})->value, 0x8000'0185u) << "refused, 0609 0030";
  device.write({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0x00});
  EXPECT_EQ(device->objects().find({0x1800, 1})->value, 0x0000'0185u);
}

}  // namespace
}  // namespace takt::sim
