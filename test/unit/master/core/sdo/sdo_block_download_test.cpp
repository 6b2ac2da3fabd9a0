#include "master/core/sdo/sdo_block_download.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <string_view>

#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

using Kind = SdoStep::Kind;
constexpr std::string_view hello = "Hello CANopen block transfer!";

/// Tests the state machine of a block download to 1F50:01 of node 5 with literal frames.
class BlockDownload : public testing::Test {
 protected:
  void begin(std::string_view text) {
    value_ = text;
    machine.begin(default_sdo_channel(5_node), {0x1F50, 1}, std::as_bytes(std::span{value_}));
  }
  void sends(const Frame& expected) {
    const auto frame = machine.to_send();
    ASSERT_TRUE(frame);
    EXPECT_EQ(*frame, expected);
    machine.sent();
  }
  void sends_segment(std::uint8_t first, std::string_view text) {
    Frame expected = tx({first});
    std::ranges::copy(text, expected.data.begin() + 1);
    sends(expected);
  }
  void waits() { EXPECT_FALSE(machine.to_send()); }
  Kind hears(const Frame& frame) { return machine.on_frame(frame).kind; }

  std::string value_;
  SdoBlockDownload machine;
};

TEST_F(BlockDownload, SendsTwentyNineBytesInOneBlock) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  waits();
  EXPECT_EQ(hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F})), Kind::goes_on);
  sends(tx({0x01, 0x48, 0x65, 0x6C, 0x6C, 0x6F, 0x20, 0x43}));
  sends(tx({0x02, 0x41, 0x4E, 0x6F, 0x70, 0x65, 0x6E, 0x20}));
  sends(tx({0x03, 0x62, 0x6C, 0x6F, 0x63, 0x6B, 0x20, 0x74}));
  sends(tx({0x04, 0x72, 0x61, 0x6E, 0x73, 0x66, 0x65, 0x72}));
  sends(tx({0x85, 0x21}));
  waits();
  EXPECT_EQ(hears(rx({0xA2, 0x05, 0x7F})), Kind::goes_on);
  sends(tx({0xD9, 0xC3, 0xBA}));
  waits();
  EXPECT_EQ(hears(rx({0xA1})), Kind::done);
}

TEST_F(BlockDownload, ConfirmsBlocksOfThreeSegments) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x03}));
  sends_segment(0x01, "Hello C");
  sends_segment(0x02, "ANopen ");
  sends_segment(0x03, "block t");
  waits();
  hears(rx({0xA2, 0x03, 0x03}));
  EXPECT_EQ(machine.moved(), 21U);
  sends(tx({0x01, 0x72, 0x61, 0x6E, 0x73, 0x66, 0x65, 0x72}));
  sends(tx({0x82, 0x21}));
  hears(rx({0xA2, 0x02, 0x03}));
  sends(tx({0xD9, 0xC3, 0xBA}));
  EXPECT_EQ(hears(rx({0xA1})), Kind::done);
}

TEST_F(BlockDownload, RepeatsFromTheSegmentThatWasLost) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x04}));
  sends_segment(0x01, "Hello C");
  sends_segment(0x02, "ANopen ");
  sends_segment(0x03, "block t");
  sends_segment(0x04, "ransfer");
  waits();
  hears(rx({0xA2, 0x01, 0x04}));
  sends_segment(0x01, "ANopen ");
  sends_segment(0x02, "block t");
  sends_segment(0x03, "ransfer");
  sends_segment(0x84, "!");
  hears(rx({0xA2, 0x04, 0x04}));
  sends(tx({0xD9, 0xC3, 0xBA}));  // the CRC counts each byte once
}

TEST_F(BlockDownload, RepeatsAfterALossInTheLastBlock) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  for (int i = 0; i < 5; ++i) machine.sent();
  waits();
  hears(rx({0xA2, 0x04, 0x7F}));
  sends_segment(0x81, "!");
  hears(rx({0xA2, 0x01, 0x7F}));
  sends(tx({0xD9, 0xC3, 0xBA}));
}

TEST_F(BlockDownload, StopsItsBlockWhenTheServerConfirmsEarly) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  sends_segment(0x01, "Hello C");
  sends_segment(0x02, "ANopen ");
  sends_segment(0x03, "block t");
  hears(rx({0xA2, 0x01, 0x7F}));
  sends_segment(0x01, "ANopen ");
}

TEST_F(BlockDownload, FollowsTheBlockSizeOfEachConfirmation) {
  begin(std::string(7 * 6, 'x'));
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x2A}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x02}));
  sends_segment(0x01, "xxxxxxx");
  sends_segment(0x02, "xxxxxxx");
  waits();
  hears(rx({0xA2, 0x02, 0x01}));
  sends_segment(0x01, "xxxxxxx");
  waits();
  hears(rx({0xA2, 0x01, 0x03}));
  sends_segment(0x01, "xxxxxxx");
  sends_segment(0x02, "xxxxxxx");
  sends_segment(0x83, "xxxxxxx");
  waits();
  hears(rx({0xA2, 0x03, 0x7F}));
  EXPECT_EQ(machine.to_send()->data[0], 0xC1);  // the last segment is full
}

TEST_F(BlockDownload, RepeatsAllWhenNothingWasReceivedButNotForEver) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  SdoStep step{.kind = Kind::goes_on};
  int rounds = 0;
  while (step.kind == Kind::goes_on && rounds < 100) {
    sends_segment(0x01, "Hello C");
    step = machine.on_frame(rx({0xA2, 0x00, 0x7F}));
    ++rounds;
  }
  EXPECT_EQ(step.kind, Kind::abort);
  EXPECT_EQ(step.abort_code, 0x05040003U);
  EXPECT_EQ(rounds, 16);
}

TEST_F(BlockDownload, SendsNoCrcWhenTheServerCannot) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA0, 0x50, 0x1F, 0x01, 0x7F}));
  for (int i = 0; i < 5; ++i) machine.sent();
  hears(rx({0xA2, 0x05, 0x7F}));
  sends(tx({0xD9, 0x00, 0x00}));
}

TEST_F(BlockDownload, AbortsABlockSizeOfZeroOr128) {
  for (const std::uint8_t size : {std::uint8_t{0}, std::uint8_t{128}, std::uint8_t{255}}) {
    begin(hello);
    machine.sent();
    const SdoStep begun = machine.on_frame(rx({0xA4, 0x50, 0x1F, 0x01, size}));
    EXPECT_EQ(begun.kind, Kind::abort);
    EXPECT_EQ(begun.abort_code, 0x05040002U);

    begin(hello);
    machine.sent();
    hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x01}));
    machine.sent();
    EXPECT_EQ(machine.on_frame(rx({0xA2, 0x01, size})).abort_code, 0x05040002U);
  }
}

TEST_F(BlockDownload, AbortsAConfirmationOfMoreThanWasSent) {
  begin(hello);
  machine.sent();
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  machine.sent();
  machine.sent();
  EXPECT_EQ(machine.on_frame(rx({0xA2, 0x03, 0x7F})).abort_code, 0x05040003U);
}

TEST_F(BlockDownload, TakesEachAnswerOnceThatComesTwice) {
  begin(hello);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x1D}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x03}));
  EXPECT_EQ(hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x03})), Kind::stranger);
  sends_segment(0x01, "Hello C");
  EXPECT_EQ(hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x03})), Kind::stranger);
  sends_segment(0x02, "ANopen ");
  sends_segment(0x03, "block t");
  hears(rx({0xA2, 0x03, 0x03}));
  EXPECT_EQ(hears(rx({0xA2, 0x03, 0x03})), Kind::stranger);
  sends_segment(0x01, "ransfer");
  EXPECT_EQ(hears(rx({0xA2, 0x03, 0x03})), Kind::stranger);
  sends_segment(0x82, "!");
  hears(rx({0xA2, 0x02, 0x03}));
  EXPECT_EQ(hears(rx({0xA2, 0x02, 0x03})), Kind::stranger);
  sends(tx({0xD9, 0xC3, 0xBA}));
  EXPECT_EQ(hears(rx({0xA1})), Kind::done);
}

TEST_F(BlockDownload, TakesNoAnswerForAnotherObject) {
  begin(hello);
  machine.sent();
  EXPECT_EQ(hears(rx({0xA4, 0x50, 0x1F, 0x02, 0x7F})), Kind::stranger);
  EXPECT_EQ(hears(rx({0xA1})), Kind::stranger);
  EXPECT_EQ(hears(rx({0x60, 0x50, 0x1F, 0x01})), Kind::stranger);
}

}  // namespace
}  // namespace takt
