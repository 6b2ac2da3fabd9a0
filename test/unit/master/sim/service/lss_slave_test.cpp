#include "master/sim/service/lss_slave.hpp"

#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;
using Bytes = std::array<std::uint8_t, 8>;

/// Makes a device with vendor-ID 0x15A, product code 2, revision 0x00010003 and serial number 0xA5.
DeviceTable table_with(const std::string& quirk) {
  SampleDevice device = communicating(5_node);
  device.quirk(quirk)
      .object(0x1018, 2, DataType::unsigned32, Access::ro, 2)
      .object(0x1018, 3, DataType::unsigned32, Access::ro, 0x0001'0003)
      .object(0x1018, 4, DataType::unsigned32, Access::ro, 0xA5);
  device.pdo(0x1800, 0x185, 255, {0x2010'0020});
  return device.build();
}

class LssSlaveTest : public ::testing::Test {
 protected:
  void build(const std::string& quirk) {
    device.emplace(table_with(quirk), Random{1});
    device->power_on(now);
    run(100ms);
  }
  void run(Time span) {
    const Time until = now + span;
    while (device->deadline() <= until) {
      now = std::max(now, device->deadline());
      device->on_time(now);
      collect();
    }
    now = until;
  }
  void collect() {
    for (const Transmission& item : device->out().pending()) declared.push_back(item.frame);
    device->out().clear();
  }
  /// Returns the answer to one request; all bytes are zero if there is none.
  Bytes ask(Bytes request) {
    declared.clear();
    device->on_frame({.id = CobId::base(0x7E5), .length = 8, .data = request}, now);
    collect();
    run(5ms);
    for (const Frame& frame : declared) {
      if (frame.id == CobId::base(0x7E4)) return frame.data;
    }
    return {};
  }
  void nmt(std::uint8_t command, std::uint8_t node) {
    device->on_frame(make_frame(CobId::base(0), {command, node}), now);
    collect();
    run(100ms);
  }
  bool booted_as(std::uint8_t node) const {
    return std::ranges::find(declared, make_frame(CobId::base(0x700u + node), {0})) !=
           declared.end();
  }

  std::optional<Device> device;
  Time now = 1s;
  std::vector<Frame> declared;
  const Bytes silence{};
};

TEST_F(LssSlaveTest, SaysNothingWithoutNodeId) {
  build("no_node_id");
  nmt(1, 0);
  device->on_frame(make_frame(CobId::base(0x605), {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}), now);
  run(1s);
  EXPECT_TRUE(declared.empty());
  EXPECT_FALSE(device->address());
}

TEST_F(LssSlaveTest, IsSelectedByAllFourNumbersInOrder) {
  build("lss");
  EXPECT_EQ(ask({0x40, 0x5A, 0x01}), silence);
  EXPECT_EQ(ask({0x41, 0x02}), silence);
  EXPECT_EQ(ask({0x42, 0x03, 0x00, 0x01}), silence);
  EXPECT_EQ(ask({0x43, 0xA5}), (Bytes{0x44}));
  EXPECT_EQ(ask({0x5E}), (Bytes{0x5E, 5}));
}

TEST_F(LssSlaveTest, IsNotSelectedWhenOneNumberDiffers) {
  build("lss");
  ask({0x40, 0x5A, 0x01});
  ask({0x41, 0x03});
  ask({0x42, 0x03, 0x00, 0x01});
  EXPECT_EQ(ask({0x43, 0xA5}), silence);
  EXPECT_EQ(ask({0x5E}), silence);
}

TEST_F(LssSlaveTest, AnswersInquiriesInConfigurationStateOnly) {
  build("lss");
  EXPECT_EQ(ask({0x5A}), silence);
  ask({0x04, 0x01});
  EXPECT_EQ(ask({0x5A}), (Bytes{0x5A, 0x5A, 0x01}));
  EXPECT_EQ(ask({0x5B}), (Bytes{0x5B, 0x02}));
  EXPECT_EQ(ask({0x5C}), (Bytes{0x5C, 0x03, 0x00, 0x01}));
  EXPECT_EQ(ask({0x5D}), (Bytes{0x5D, 0xA5}));
  ask({0x04, 0x00});
  EXPECT_EQ(ask({0x5A}), silence);
}

TEST_F(LssSlaveTest, StartsWithTheIdThatItGot) {
  build("no_node_id");
  ask({0x04, 0x01});
  EXPECT_EQ(ask({0x11, 0x21}), (Bytes{0x11, 0x00}));
  EXPECT_EQ(ask({0x5E}), (Bytes{0x5E, 0xFF}));
  EXPECT_FALSE(device->address());

  ask({0x04, 0x00});
  run(100ms);

  EXPECT_TRUE(booted_as(0x21));
  EXPECT_EQ(device->address(), 33_node);
  EXPECT_EQ(device->objects().number({0x1800, 1}), 0x1A1);
  EXPECT_EQ(device->objects().number({0x1014, 0}), 0x0A1);
}

TEST_F(LssSlaveTest, KeepsItsOldIdUntilItIsReset) {
  build("lss");
  ask({0x04, 0x01});
  EXPECT_EQ(ask({0x11, 0xC8}), (Bytes{0x11, 0x01}));
  EXPECT_EQ(ask({0x11, 0x06}), (Bytes{0x11, 0x00}));
  ask({0x04, 0x00});
  run(1s);
  EXPECT_EQ(device->address(), 5_node);
  nmt(130, 5);
  EXPECT_TRUE(booted_as(6));
}

TEST_F(LssSlaveTest, ForgetsAnIdThatIsNotStored) {
  build("no_node_id");
  for (const bool stores : {false, true}) {
    ask({0x04, 0x01});
    ask({0x11, 0x07});
    if (stores) device->on_frame({.id = CobId::base(0x7E5), .length = 8, .data = {0x17}}, now);
    run(50ms);
    ask({0x04, 0x00});
    run(100ms);
    ASSERT_EQ(device->address(), 7_node);
    device->power_off();
    device->power_on(now);
    run(100ms);
    EXPECT_EQ(device->address().has_value(), stores);
  }
}

TEST_F(LssSlaveTest, SaysThatItCannotStore) {
  build("no_node_id");
  device->lss()->faults().refuses_store = true;
  ask({0x04, 0x01});
  declared.clear();
  device->on_frame({.id = CobId::base(0x7E5), .length = 8, .data = {0x17}}, now);
  collect();
  ASSERT_EQ(declared.size(), 1U);
  EXPECT_EQ(declared[0].data, (Bytes{0x17, 0x02}));
}

TEST_F(LssSlaveTest, AnswersTheLastFrameOfAnIdentification) {
  build("lss");
  const auto identify = [&](std::uint8_t serial_from, std::uint8_t serial_to) {
    ask({0x46, 0x5A, 0x01});
    ask({0x47, 0x02});
    ask({0x48, 0x00, 0x00, 0x01});
    ask({0x49, 0xFF, 0xFF, 0x01});
    ask({0x4A, serial_from});
    return ask({0x4B, serial_to});
  };
  EXPECT_EQ(identify(0, 0xFF), (Bytes{0x4F}));
  EXPECT_EQ(identify(0xA5, 0xA5), (Bytes{0x4F}));
  EXPECT_EQ(identify(0xA6, 0xFF), silence);
  EXPECT_EQ(identify(0, 0xA4), silence);
}

TEST_F(LssSlaveTest, TakesPartInScansOnlyWithoutNodeId) {
  build("lss");
  EXPECT_EQ(ask({0x4C}), silence);
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x80}), silence);
  build("no_node_id");
  EXPECT_EQ(ask({0x4C}), (Bytes{0x50}));
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x80}), (Bytes{0x4F}));
}

TEST_F(LssSlaveTest, FollowsAFastscanToTheEnd) {
  build("no_node_id");
  ASSERT_EQ(ask({0x51, 0, 0, 0, 0, 0x80, 0, 0}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x09, 0, 0}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x08, 0, 0}), silence);
  EXPECT_EQ(ask({0x51, 0x5A, 0x01, 0, 0, 0x00, 0, 1}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x51, 0x5A, 0x01, 0, 0, 0x00, 0, 1}), silence);  // now at the product code
  EXPECT_EQ(ask({0x51, 0x02, 0, 0, 0, 0x00, 1, 2}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x51, 0x03, 0, 1, 0, 0x00, 2, 3}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x51, 0xA4, 0, 0, 0, 0x01, 3, 3}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x5D}), silence);
  EXPECT_EQ(ask({0x51, 0xA5, 0, 0, 0, 0x00, 3, 0}), (Bytes{0x4F}));
  EXPECT_EQ(ask({0x5D}), (Bytes{0x5D, 0xA5}));
}

TEST_F(LssSlaveTest, IgnoresAFastscanThatMakesNoSense) {
  build("no_node_id");
  ask({0x51, 0, 0, 0, 0, 0x80, 0, 0});
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x20, 0, 0}), silence);
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x81, 0, 0}), silence);
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x1F, 4, 0}), silence);
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x1F, 0, 4}), silence);
}

TEST_F(LssSlaveTest, IsSilentForTwoDelaysAroundANewBitRate) {
  build("lss");
  ask({0x04, 0x01});
  EXPECT_EQ(ask({0x13, 0x00, 0x05}), (Bytes{0x13, 0x01}));
  EXPECT_EQ(ask({0x13, 0x01, 0x00}), (Bytes{0x13, 0x01}));
  EXPECT_EQ(ask({0x13, 0x00, 0x03}), (Bytes{0x13, 0x00}));
  EXPECT_EQ(device->bit_rate(), 0U);
  const Time begun = now;
  device->on_frame({.id = CobId::base(0x7E5), .length = 8, .data = {0x15, 0x64, 0x00}}, now);

  run(99ms);
  EXPECT_EQ(device->bit_rate(), 0U);
  run(2ms);
  EXPECT_EQ(device->bit_rate(), 250U);
  EXPECT_EQ(ask({0x5E}), silence);
  run(begun + 201ms - now);
  EXPECT_EQ(ask({0x5E}), (Bytes{0x5E, 5}));
}

TEST_F(LssSlaveTest, AnswersNothingWhenItIsSilent) {
  build("no_node_id");
  device->lss()->faults().silent = true;
  EXPECT_EQ(ask({0x51, 0, 0, 0, 0, 0x80}), silence);
  EXPECT_EQ(ask({0x4C}), silence);
}

}  // namespace
}  // namespace takt::sim
