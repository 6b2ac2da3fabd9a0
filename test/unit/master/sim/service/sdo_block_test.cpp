#include <array>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;
using Bytes = std::array<std::uint8_t, 8>;
constexpr std::string_view hello = "Hello CANopen block transfer!";

DeviceTable block_device() {
  return communicating(5_node).text(0x1021, 0, hello).text(0x2020, 0, "", Access::rw).build();
}

Bytes padded(std::uint8_t first, std::string_view text) {
  Bytes bytes{first};
  std::ranges::copy(text, bytes.begin() + 1);
  return bytes;
}

/// A device after its boot-up, and literal frames of a block transfer.
class SdoBlockServer : public testing::Test {
 protected:
  SdoBlockServer() {
    device_.power_on(0ns);
    device_.on_time(50ms);
    device_.out().clear();
  }
  /// Returns all answers of the device until it waits.
  std::vector<Bytes> ask(Bytes request) {
    now_ += 1ms;
    device_.on_frame({.id = CobId::base(0x605), .length = 8, .data = request}, now_);
    return answers();
  }
  std::vector<Bytes> answers() {
    std::vector<Bytes> all;
    for (int i = 0; i < 200; ++i) {
      for (const Transmission& item : device_.out().pending()) {
        if (item.frame.id == CobId::base(0x585)) all.push_back(item.frame.data);
      }
      device_.out().clear();
      if (device_.deadline() > now_ + 10ms) break;
      now_ = std::max(now_, device_.deadline());
      device_.on_time(now_);
    }
    return all;
  }
  std::vector<Bytes> wait(Time span) {
    now_ += span;
    device_.on_time(now_);
    return answers();
  }
  std::string stored() {
    const auto& bytes = device_.objects().find({0x2020, 0})->bytes;
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  void send_hello() {
    ask(padded(0x01, "Hello C"));
    ask(padded(0x02, "ANopen "));
    ask(padded(0x03, "block t"));
    ask(padded(0x04, "ransfer"));
  }

  using Frames = std::vector<Bytes>;
  Device device_{block_device(), Random{1}};
  Time now_ = 50ms;
};

TEST_F(SdoBlockServer, TakesTwentyNineBytesInOneBlock) {
  EXPECT_EQ(ask({0xC6, 0x20, 0x20, 0x00, 0x1D}), (Frames{{0xA4, 0x20, 0x20, 0x00, 0x7F}}));
  send_hello();
  EXPECT_EQ(ask({0x85, 0x21}), (Frames{{0xA2, 0x05, 0x7F}}));
  EXPECT_EQ(ask({0xD9, 0xC3, 0xBA}), (Frames{{0xA1}}));
  EXPECT_EQ(stored(), hello);
}

TEST_F(SdoBlockServer, ConfirmsBlocksOfThreeSegments) {
  device_.faults().sdo.block_size = 3;
  EXPECT_EQ(ask({0xC6, 0x20, 0x20, 0x00, 0x1D}), (Frames{{0xA4, 0x20, 0x20, 0x00, 0x03}}));
  EXPECT_EQ(ask(padded(0x01, "Hello C")), Frames{});
  EXPECT_EQ(ask(padded(0x02, "ANopen ")), Frames{});
  EXPECT_EQ(ask(padded(0x03, "block t")), (Frames{{0xA2, 0x03, 0x03}}));
  EXPECT_EQ(ask({0x01, 0x72, 0x61, 0x6E, 0x73, 0x66, 0x65, 0x72}), Frames{});
  EXPECT_EQ(ask({0x82, 0x21}), (Frames{{0xA2, 0x02, 0x03}}));
  EXPECT_EQ(ask({0xD9, 0xC3, 0xBA}), (Frames{{0xA1}}));
  EXPECT_EQ(stored(), hello);
}

TEST_F(SdoBlockServer, ConfirmsOnlyWhatCameBeforeAGap) {
  device_.faults().sdo.block_size = 4;
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  ask(padded(0x01, "Hello C"));
  ask(padded(0x03, "block t"));
  EXPECT_EQ(ask(padded(0x04, "ransfer")), (Frames{{0xA2, 0x01, 0x04}}));
  ask(padded(0x01, "ANopen "));
  ask(padded(0x02, "block t"));
  ask(padded(0x03, "ransfer"));
  EXPECT_EQ(ask({0x84, 0x21}), (Frames{{0xA2, 0x04, 0x04}}));
  EXPECT_EQ(ask({0xD9, 0xC3, 0xBA}), (Frames{{0xA1}}));
  EXPECT_EQ(stored(), hello);
}

TEST_F(SdoBlockServer, ConfirmsAfterAWhileWhenTheLastSegmentOfABlockIsLost) {
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  send_hello();
  EXPECT_EQ(wait(700ms), (Frames{{0xA2, 0x04, 0x7F}}));
  EXPECT_EQ(ask({0x81, 0x21}), (Frames{{0xA2, 0x01, 0x7F}}));
  EXPECT_EQ(ask({0xD9, 0xC3, 0xBA}), (Frames{{0xA1}}));
}

TEST_F(SdoBlockServer, EndsATransferWhoseClientIsGone) {
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  EXPECT_EQ(wait(1000ms), (Frames{{0x80, 0x20, 0x20, 0x00, 0x00, 0x00, 0x04, 0x05}}));
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x01}).front()[0], 0x43);
}

TEST_F(SdoBlockServer, RefusesAWrongCrcAndKeepsItsValue) {
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  send_hello();
  ask({0x85, 0x21});
  EXPECT_EQ(ask({0xD9, 0xC4, 0xBA}), (Frames{{0x80, 0x20, 0x20, 0x00, 0x04, 0x00, 0x04, 0x05}}));
  EXPECT_EQ(stored(), "");
}

TEST_F(SdoBlockServer, ChecksNoCrcWhenOneSideHasNone) {
  EXPECT_EQ(ask({0xC2, 0x20, 0x20, 0x00, 0x1D}), (Frames{{0xA0, 0x20, 0x20, 0x00, 0x7F}}));
  send_hello();
  ask({0x85, 0x21});
  EXPECT_EQ(ask({0xD9, 0x00, 0x00}), (Frames{{0xA1}}));
}

TEST_F(SdoBlockServer, RefusesMoreAndLessThanWasAnnounced) {
  ask({0xC6, 0x20, 0x20, 0x00, 28});
  send_hello();
  EXPECT_EQ(ask({0x85, 0x21}), (Frames{{0x80, 0x20, 0x20, 0x00, 0x12, 0x00, 0x07, 0x06}}));

  ask({0xC6, 0x20, 0x20, 0x00, 30});
  send_hello();
  ask({0x85, 0x21});
  EXPECT_EQ(ask({0xD9, 0xC3, 0xBA}), (Frames{{0x80, 0x20, 0x20, 0x00, 0x13, 0x00, 0x07, 0x06}}));
}

TEST_F(SdoBlockServer, RefusesASequenceNumberBeyondTheBlock) {
  device_.faults().sdo.block_size = 3;
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  EXPECT_EQ(ask({0x04}), (Frames{{0x80, 0x20, 0x20, 0x00, 0x03, 0x00, 0x04, 0x05}}));
}

TEST_F(SdoBlockServer, EndsOnAnAbortInTheMiddleOfABlock) {
  ask({0xC6, 0x20, 0x20, 0x00, 0x1D});
  ask(padded(0x01, "Hello C"));
  EXPECT_EQ(ask({0x80, 0x20, 0x20, 0x00}), Frames{});
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x01}).front()[0], 0x43);
}

TEST_F(SdoBlockServer, SendsTwentyNineBytesInTwoBlocks) {
  EXPECT_EQ(ask({0xA4, 0x21, 0x10, 0x00, 0x04}), (Frames{{0xC6, 0x21, 0x10, 0x00, 0x1D}}));
  EXPECT_EQ(ask({0xA3}), (Frames{padded(0x01, "Hello C"), padded(0x02, "ANopen "),
                                 padded(0x03, "block t"), padded(0x04, "ransfer")}));
  EXPECT_EQ(ask({0xA2, 0x04, 0x04}), (Frames{{0x81, 0x21}}));
  EXPECT_EQ(ask({0xA2, 0x01, 0x04}), (Frames{{0xD9, 0xC3, 0xBA}}));
  EXPECT_EQ(ask({0xA1}), Frames{});
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x01}).front()[0], 0x43);
}

TEST_F(SdoBlockServer, RepeatsWhatWasNotConfirmed) {
  ask({0xA4, 0x21, 0x10, 0x00, 0x04});
  ask({0xA3});
  EXPECT_EQ(ask({0xA2, 0x01, 0x04}), (Frames{padded(0x01, "ANopen "),
                                             padded(0x02, "block t"),
                                             padded(0x03, "ransfer"),
                                             {0x84, 0x21}}));
  EXPECT_EQ(ask({0xA2, 0x00, 0x01}), (Frames{padded(0x01, "ANopen ")}));
}

TEST_F(SdoBlockServer, RefusesToHaveSentLessThanIsConfirmed) {
  ask({0xA4, 0x21, 0x10, 0x00, 0x04});
  ask({0xA3});
  EXPECT_EQ(ask({0xA2, 0x05, 0x04}), (Frames{{0x80, 0x21, 0x10, 0x00, 0x03, 0x00, 0x04, 0x05}}));
}

TEST_F(SdoBlockServer, RefusesABlockSizeOfZero) {
  EXPECT_EQ(ask({0xA4, 0x21, 0x10, 0x00, 0x00}),
            (Frames{{0x80, 0x21, 0x10, 0x00, 0x02, 0x00, 0x04, 0x05}}));
  ask({0xA4, 0x21, 0x10, 0x00, 0x04});
  ask({0xA3});
  EXPECT_EQ(ask({0xA2, 0x04, 0x80}), (Frames{{0x80, 0x21, 0x10, 0x00, 0x02, 0x00, 0x04, 0x05}}));
}

TEST_F(SdoBlockServer, SwitchesTheProtocolUpToTheThreshold) {
  EXPECT_EQ(ask({0xA4, 0x21, 0x10, 0x00, 0x04, 28}), (Frames{{0xC6, 0x21, 0x10, 0x00, 0x1D}}));
  ask({0x80, 0x21, 0x10, 0x00});
  EXPECT_EQ(ask({0xA4, 0x21, 0x10, 0x00, 0x04, 29}), (Frames{{0x41, 0x21, 0x10, 0x00, 0x1D}}));
  ask({0x80, 0x21, 0x10, 0x00});
  EXPECT_EQ(ask({0xA4, 0x18, 0x10, 0x01, 0x04, 0}), (Frames{{0xC6, 0x18, 0x10, 0x01, 0x04}}));
}

TEST_F(SdoBlockServer, RefusesBlockTransferWhenItKnowsNone) {
  device_.faults().sdo.refuse_block = true;
  const Bytes refusal{0x80, 0x20, 0x20, 0x00, 0x01, 0x00, 0x04, 0x05};
  EXPECT_EQ(ask({0xC6, 0x20, 0x20, 0x00, 0x1D}), Frames{refusal});
  EXPECT_EQ(ask({0x21, 0x20, 0x20, 0x00, 0x1D}), (Frames{{0x60, 0x20, 0x20, 0x00}}));
}

TEST_F(SdoBlockServer, ServesAFurtherChannelThatItsDictionaryHas) {
  using enum DataType;
  Device device{communicating(5_node)
                    .object(0x1201, 0, unsigned8, Access::ro, 2)
                    .object(0x1201, 1, unsigned32, Access::rw, 0x645)
                    .object(0x1201, 2, unsigned32, Access::rw, 0x5C5)
                    .build(),
                Random{1}};
  device.power_on(0ns);
  device.on_time(50ms);
  device.out().clear();
  device.on_frame(make_frame(CobId::base(0x645), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}), 60ms);
  ASSERT_EQ(device.out().pending().size(), 1u);
  EXPECT_EQ(device.out().pending()[0].frame,
            make_frame(CobId::base(0x5C5), {0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0, 0}));
}

}  // namespace
}  // namespace takt::sim
