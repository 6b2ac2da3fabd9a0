#include "test/unit/master/core/sdo/sdo_client_block.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST_F(SdoClientBlock, ChoosesBlockFor128BytesAndSegmentsFor127) {
  download(127);
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0x7F}));
  client.drop();
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  EXPECT_EQ(answer, Answer::by_server);
}

TEST_F(SdoClientBlock, NeverUsesBlockWhereItIsForbidden) {
  client = SdoClient{default_sdo_channel(5_node), SdoBlockUse::off};
  download(1000);
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0xE8, 0x03}));
  client.drop();
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends(tx({0x40, 0x21, 0x10, 0x00}));
}

TEST_F(SdoClientBlock, TalksOnAnotherChannel) {
  client = SdoClient{{.request = CobId::base(0x645), .answer = CobId::base(0x5C5)}};
  client.upload({0x1018, 1}, buffer, 500ms);
  sends(padded(CobId::base(0x645), {0x40, 0x18, 0x10, 0x01}));
  now += 500ms;
  sends(padded(CobId::base(0x645), {0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x04, 0x05}));
}

TEST_F(SdoClientBlock, SaysWhichFramesGetNoAnswer) {
  download(128);  // 19 segments
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  Outbox out;
  for (int i = 0; i < 30; ++i) client.on_time(now, out);
  ASSERT_EQ(out.frames().size(), 19U);
  EXPECT_EQ(out.answers()[0], Answer::none);
  EXPECT_EQ(out.answers()[17], Answer::none);
  EXPECT_EQ(out.answers()[18], Answer::by_server);
  EXPECT_EQ(client.deadline(), now + 500ms);
}

TEST_F(SdoClientBlock, TakesNoAbortBeforeItHasAskedForAnything) {
  download(128);
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.take_result());
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
}

TEST_F(SdoClientBlock, TakesTheOrdinaryAnswerBelowTheThreshold) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends(tx({0xA4, 0x21, 0x10, 0x00, 0x7F, 0x1C}));
  hears(rx({0x41, 0x21, 0x10, 0x00, 0x09}));
  sends(tx({0x60}));
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));
  sends(tx({0x70}));
  hears(rx({0x1B, 8, 9}));
  EXPECT_EQ(client.take_result()->size, 9U);
}

TEST_F(SdoClientBlock, ConfirmsWhatItHasWhenTheServerFallsSilentInABlock) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends(tx({0xA4, 0x21, 0x10, 0x00, 0x7F, 0x1C}));
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0x0E}));
  sends(tx({0xA3}));
  now += 10ms;
  hears(segment(0x01, {1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(client.deadline(), now + 350ms);
  now += 350ms;
  sends(tx({0xA2, 0x01, 0x7F}));
  EXPECT_EQ(client.deadline(), now + 500ms);
  now += 500ms;
  sends(tx({0x80, 0x21, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::timeout);
}

TEST_F(SdoClientBlock, TakesShortFramesThatSayEverything) {
  const auto short_rx = [](std::initializer_list<std::uint8_t> bytes) {
    return make_frame(CobId::base(0x585), bytes);
  };
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends(tx({0xA4, 0x21, 0x10, 0x00, 0x7F, 0x1C}));
  hears(short_rx({0xC0, 0x21, 0x10, 0x00}));
  sends(tx({0xA3}));
  hears(short_rx({0x01, 1, 2}));  // not the last segment, so that data is missing
  hears(segment(0x01, {1, 2, 3, 4, 5, 6, 7}));
  hears(short_rx({0x82, 8, 9}));
  sends(tx({0xA2, 0x02, 0x7F}));
  hears(short_rx({0xD5, 0x00, 0x00}));
  EXPECT_EQ(client.take_result()->size, 9U);
  EXPECT_EQ(buffer[8], std::byte{9});
  sends(tx({0xA1}));

  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(short_rx({0xA0, 0x50, 0x1F, 0x01}));
  sends_nothing();  // the answer lacks the block size
  hears(short_rx({0xA0, 0x50, 0x1F, 0x01, 0x7F}));
  sends_some(19);
  hears(short_rx({0xA2, 0x13, 0x7F}));
  sends_some(1);
  hears(short_rx({0xA1}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
}

TEST_F(SdoClientBlock, TimesOutInEveryStateOfADownloadThatWasAnswered) {
  const Frame timeout = tx({0x80, 0x50, 0x1F, 0x01, 0x00, 0x00, 0x04, 0x05});
  for (int steps = 1; steps < 3; ++steps) {
    client.drop();
    download(128);
    sends_some(1);
    hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
    sends_some(19);
    if (steps > 1) hears(rx({0xA2, 0x13, 0x7F}));
    if (steps > 1) sends_some(1);
    now += 500ms;
    sends(timeout);
    EXPECT_EQ(client.take_result()->fault, SdoFault::timeout);
    EXPECT_TRUE(client.idle());
  }
}

TEST_F(SdoClientBlock, CancelsInTheMiddleOfABlock) {
  download(128);
  sends_some(1);
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  sends_some(5);
  client.cancel();
  sends(tx({0x80, 0x50, 0x1F, 0x01, 0x00, 0x00, 0x00, 0x08}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends_nothing();
}

TEST_F(SdoClientBlock, IgnoresLateSegmentsOfABlockThatWasGivenUp) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends_some(1);
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0x80}));
  sends_some(1);
  client.cancel();
  client.take_result();
  sends_some(1);

  client.upload({0x1018, 1}, buffer, 500ms);
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  for (unsigned first = 0x01; first <= 0xE1; first += 0x20) {
    hears(segment(static_cast<std::uint8_t>(first), {1, 2, 3, 4, 5, 6, 7}));
  }
  EXPECT_FALSE(client.take_result());
  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
}

TEST_F(SdoClientBlock, TheEndOfADownloadThatCanRepeatsEndsNothingElse) {
  download(128);
  sends_some(1);
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  sends_some(19);
  hears(rx({0xA2, 0x13, 0x7F}));
  sends_some(1);
  hears(rx({0xA1}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);

  client.upload({0x1018, 1}, buffer, 500ms);
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  hears(rx({0xA1}));
  EXPECT_FALSE(client.take_result());
  hears(rx({0x80, 0x00, 0x00, 0x00, 0x01, 0x00, 0x04, 0x05}));  // the server received our end twice
  EXPECT_FALSE(client.take_result());
  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
}

TEST_F(SdoClientBlock, TheEndOfAnUploadThatCanRepeatsEndsNothingElse) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends_some(1);
  hears(rx({0xC2, 0x21, 0x10, 0x00, 0x02}));
  sends_some(1);
  hears(segment(0x81, {1, 2}));
  sends_some(1);
  hears(rx({0xD5}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
  sends(tx({0xA1}));

  value_.assign(4, std::byte{0x55});
  client.download({0x6081, 0}, value_, 500ms);
  sends_some(1);
  hears(rx({0xD5}));
  hears(rx({0x80, 0x21, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));  // the server received our end twice
  EXPECT_FALSE(client.take_result());
  hears(rx({0x60, 0x81, 0x60, 0x00}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
}

TEST_F(SdoClientBlock, AnEndThatTheServerHeardTwiceIsNoRefusalOfTheNextBlock) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends_some(1);
  hears(rx({0xC2, 0x21, 0x10, 0x00, 0x02}));
  sends_some(1);
  hears(segment(0x81, {1, 2}));
  sends_some(1);
  hears(rx({0xD5}));
  client.take_result();
  sends_some(1);

  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(rx({0x80, 0x00, 0x00, 0x00, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.take_no_block());
  sends_nothing();
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  sends_some(19);
}

TEST_F(SdoClientBlock, OnlyOneAbortIsTakenForThatOfARepeatedEnd) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends_some(1);
  hears(rx({0xC2, 0x21, 0x10, 0x00, 0x02}));
  sends_some(1);
  hears(segment(0x81, {1, 2}));
  sends_some(1);
  hears(rx({0xD5}));
  client.take_result();
  sends_some(1);

  client.upload({0x1018, 1}, buffer, 500ms);
  sends_some(1);
  hears(rx({0x80, 0x00, 0x00, 0x00, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.take_result());
  hears(rx({0x80, 0x00, 0x00, 0x00, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_result()->abort_code, 0x05040001U);
}

TEST_F(SdoClientBlock, ABlockAnswerToAPlainRequestIsAFaultOfTheServer) {
  client.upload({0x1018, 1}, buffer, 500ms);
  sends_some(1);
  hears(rx({0xC6, 0x18, 0x10, 0x01, 0x04}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::aborted_by_master);
}

}  // namespace
}  // namespace takt
