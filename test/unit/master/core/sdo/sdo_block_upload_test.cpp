#include "master/core/sdo/sdo_block_upload.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <string>
#include <string_view>

#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

using Kind = SdoStep::Kind;
constexpr std::string_view hello = "Hello CANopen block transfer!";

Frame segment(std::uint8_t first, std::initializer_list<std::uint8_t> data) {
  Frame frame = rx({first});
  std::ranges::copy(data, frame.data.begin() + 1);
  return frame;
}

/// Tests the state machine of a block upload of 1021:00 of node 5 with literal frames.
class BlockUpload : public testing::Test {
 protected:
  void begin(std::uint8_t segments = 4, std::uint8_t threshold = 0) {
    machine.begin({.channel = default_sdo_channel(5_node),
                   .object = {0x1021, 0},
                   .segments = segments,
                   .threshold = threshold},
                  buffer);
  }
  void begin_and_start() {
    begin();
    sends(tx({0xA4, 0x21, 0x10, 0x00, 0x04, 0x00}));
    hears(rx({0xC6, 0x21, 0x10, 0x00, 0x1D}));
    sends(tx({0xA3}));
  }
  void sends(const Frame& expected) {
    const auto frame = machine.to_send();
    ASSERT_TRUE(frame);
    EXPECT_EQ(*frame, expected);
    machine.sent();
  }
  void waits() { EXPECT_FALSE(machine.to_send()); }
  Kind hears(const Frame& frame) { return machine.on_frame(frame).kind; }
  std::string text() { return {reinterpret_cast<const char*>(buffer.data()), machine.moved()}; }

  const Frame hello1 = segment(0x01, {0x48, 0x65, 0x6C, 0x6C, 0x6F, 0x20, 0x43});
  const Frame hello2 = segment(0x02, {0x41, 0x4E, 0x6F, 0x70, 0x65, 0x6E, 0x20});
  const Frame hello3 = segment(0x03, {0x62, 0x6C, 0x6F, 0x63, 0x6B, 0x20, 0x74});
  const Frame hello4 = segment(0x04, {0x72, 0x61, 0x6E, 0x73, 0x66, 0x65, 0x72});
  const Frame hello5 = segment(0x81, {0x21});
  std::array<std::byte, 64> buffer{};
  SdoBlockUpload machine;
};

TEST_F(BlockUpload, TakesTwentyNineBytesInTwoBlocks) {
  begin_and_start();
  for (const Frame& frame : {hello1, hello2, hello3}) EXPECT_EQ(hears(frame), Kind::goes_on);
  waits();
  hears(hello4);
  sends(tx({0xA2, 0x04, 0x04}));
  hears(hello5);
  sends(tx({0xA2, 0x01, 0x04}));
  EXPECT_EQ(hears(rx({0xD9, 0xC3, 0xBA})), Kind::done);
  sends(tx({0xA1}));
  EXPECT_EQ(text(), hello);
}

TEST_F(BlockUpload, ConfirmsOnlyWhatCameInSequence) {
  begin_and_start();
  hears(hello1);
  hears(hello3);  // 2 is missing
  waits();
  hears(hello4);
  sends(tx({0xA2, 0x01, 0x04}));
  hears(segment(0x01, {0x41, 0x4E, 0x6F, 0x70, 0x65, 0x6E, 0x20}));
  hears(segment(0x02, {0x62, 0x6C, 0x6F, 0x63, 0x6B, 0x20, 0x74}));
  hears(segment(0x03, {0x72, 0x61, 0x6E, 0x73, 0x66, 0x65, 0x72}));
  hears(segment(0x84, {0x21}));
  sends(tx({0xA2, 0x04, 0x04}));
  EXPECT_EQ(hears(rx({0xD9, 0xC3, 0xBA})), Kind::done);
  EXPECT_EQ(text(), hello);
}

TEST_F(BlockUpload, GoesOnWhenTheLastSegmentCameButNotAllBeforeIt) {
  begin_and_start();
  for (const Frame& frame : {hello1, hello2, hello3, hello4}) hears(frame);
  sends(tx({0xA2, 0x04, 0x04}));
  hears(segment(0x82, {0x21}));  // as if a segment 1 had been lost
  sends(tx({0xA2, 0x00, 0x04}));
  hears(hello5);
  sends(tx({0xA2, 0x01, 0x04}));
  EXPECT_EQ(hears(rx({0xD9, 0xC3, 0xBA})), Kind::done);
}

TEST_F(BlockUpload, TakesADuplicateOnce) {
  begin_and_start();
  for (const Frame& frame : {hello1, hello2, hello2, hello3, hello4}) hears(frame);
  sends(tx({0xA2, 0x04, 0x04}));
  hears(hello5);
  sends(tx({0xA2, 0x01, 0x04}));
  EXPECT_EQ(hears(rx({0xD9, 0xC3, 0xBA})), Kind::done);
}

TEST_F(BlockUpload, ConfirmsABlockOnceWhoseLastSegmentComesTwice) {
  begin_and_start();
  for (const Frame& frame : {hello1, hello2, hello3, hello4, hello4}) hears(frame);
  sends(tx({0xA2, 0x04, 0x04}));
  waits();
  hears(hello5);
  sends(tx({0xA2, 0x01, 0x04}));
  EXPECT_EQ(hears(rx({0xD9, 0xC3, 0xBA})), Kind::done);
  EXPECT_EQ(text(), hello);
}

TEST_F(BlockUpload, TakesARepeatedLastSegmentForNoEnd) {
  std::array<std::byte, 512> room{};
  machine.begin({.channel = default_sdo_channel(5_node), .object = {0x1021, 0}, .segments = 127},
                room);
  machine.sent();
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0xC7, 0x01}));  // 455 bytes: 65 full segments
  machine.sent();
  const Frame last = segment(0xC1, {'a', 'b', 'c', 'd', 'e', 'f', 'g'});
  for (std::uint8_t number = 1; number < 65; ++number) hears(segment(number, {'x'}));
  hears(last);
  EXPECT_EQ(hears(last), Kind::stranger);
  sends(tx({0xA2, 0x41, 0x7F}));
  EXPECT_EQ(hears(last), Kind::stranger);
  EXPECT_EQ(hears(rx({0xC1, 0x57, 0x73})), Kind::done);
  EXPECT_EQ(machine.moved(), 455U);
}

TEST_F(BlockUpload, TakesTheEndOfManyZerosThoughItIsLikeTheLastSegment) {
  std::array<std::byte, 512> room{};
  machine.begin({.channel = default_sdo_channel(5_node), .object = {0x1021, 0}, .segments = 127},
                room);
  machine.sent();
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0xC7, 0x01}));
  machine.sent();
  for (std::uint8_t number = 1; number < 65; ++number) hears(segment(number, {}));
  hears(segment(0xC1, {}));
  sends(tx({0xA2, 0x41, 0x7F}));
  EXPECT_EQ(hears(rx({0xC1})), Kind::done);
}

TEST_F(BlockUpload, AbortsWhenTheCrcIsWrong) {
  begin_and_start();
  for (const Frame& frame : {hello1, hello2, hello3, hello4}) hears(frame);
  machine.sent();
  hears(hello5);
  machine.sent();
  const SdoStep step = machine.on_frame(rx({0xD9, 0xC4, 0xBA}));
  EXPECT_EQ(step.kind, Kind::abort);
  EXPECT_EQ(step.abort_code, 0x05040004U);
}

TEST_F(BlockUpload, ChecksNoCrcWhenTheServerHasNone) {
  begin();
  machine.sent();
  hears(rx({0xC2, 0x21, 0x10, 0x00, 0x1D}));
  machine.sent();
  for (const Frame& frame : {hello1, hello2, hello3, hello4}) hears(frame);
  machine.sent();
  hears(hello5);
  machine.sent();
  EXPECT_EQ(hears(rx({0xD9, 0x00, 0x00})), Kind::done);
}

TEST_F(BlockUpload, AbortsSequenceNumbersOutsideTheBlock) {
  for (const std::uint8_t number : {std::uint8_t{0x00}, std::uint8_t{0x05}, std::uint8_t{0x85}}) {
    begin_and_start();
    EXPECT_EQ(machine.on_frame(rx({number})).abort_code, 0x05040003U) << int{number};
  }
}

TEST_F(BlockUpload, AbortsMoreThanWasAnnounced) {
  begin();
  machine.sent();
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0x06}));
  machine.sent();
  hears(hello1);  // 7 bytes; the last of them may be padding
  EXPECT_EQ(machine.on_frame(hello2).abort_code, 0x06070012U);
}

TEST_F(BlockUpload, RefusesWhatDoesNotFitTheBuffer) {
  begin();
  machine.sent();
  const SdoStep step = machine.on_frame(rx({0xC6, 0x21, 0x10, 0x00, 0x41}));
  EXPECT_EQ(step.kind, Kind::abort);
  EXPECT_EQ(step.fault, SdoFault::too_long);

  begin(127);
  machine.sent();
  hears(rx({0xC4, 0x21, 0x10, 0x00}));
  machine.sent();
  Kind kind = Kind::goes_on;
  std::uint8_t number = 1;
  while (kind == Kind::goes_on && number < 20)
    kind = hears(segment(number++, {1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(kind, Kind::abort);
  EXPECT_EQ(number, 12);  // 64 bytes end in the tenth; the eleventh shows that it was not the last
}

TEST_F(BlockUpload, HandsOverWhenTheServerSwitchesToAnOrdinaryUpload) {
  begin(4, 28);
  sends(tx({0xA4, 0x21, 0x10, 0x00, 0x04, 0x1C}));
  EXPECT_EQ(hears(rx({0x43, 0x21, 0x10, 0x00, 1, 2, 3, 4})), Kind::plain);
}

}  // namespace
}  // namespace takt
