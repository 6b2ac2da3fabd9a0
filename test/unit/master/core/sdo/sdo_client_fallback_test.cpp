// The fallback of a block transfer that the server refuses or does not answer.
#include <gtest/gtest.h>

#include "test/unit/master/core/sdo/sdo_client_block.hpp"

namespace takt {
namespace {

using SdoClientFallback = SdoClientBlock;

TEST_F(SdoClientFallback, FallsBackToSegmentsWhenTheServerKnowsNoBlock) {
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x01, 0x00, 0x04, 0x05}));
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0x80}));
  client.cancel();
  client.take_result();
  sends_some(1);
  download(128);
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0x80}));  // the client has learnt that
}

TEST_F(SdoClientFallback, FallsBackInAnUploadToo) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends(tx({0xA4, 0x21, 0x10, 0x00, 0x7F, 0x1C}));
  hears(rx({0x80, 0x21, 0x10, 0x00, 0x02, 0x00, 0x04, 0x05}));
  sends(tx({0x40, 0x21, 0x10, 0x00}));
  hears(rx({0x4F, 0x21, 0x10, 0x00, 0x07}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
}

TEST_F(SdoClientFallback, ReportsARefusalThatHasNothingToDoWithBlock) {
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x02, 0x00, 0x01, 0x06}));
  EXPECT_EQ(client.take_result()->abort_code, 0x06010002U);
  sends_nothing();
}

TEST_F(SdoClientFallback, DoesNotFallBackOnceDataHaveMoved) {
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));
  sends_some(5);
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.take_result());
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x01, 0x00, 0x04, 0x05}));  // abort for a segment in transit
  now += 20ms;
  sends_nothing();
  const auto result = client.take_result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->fault, SdoFault::aborted_by_device);
  EXPECT_TRUE(client.idle());
}

TEST_F(SdoClientFallback, GoesBySegmentsWhereADownloadFindsNoAnswer) {
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
  now += 500ms;
  sends(tx({0x80, 0x50, 0x1F, 0x01, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_EQ(answer, Answer::none);
  EXPECT_FALSE(client.take_result());
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0x80}));
  EXPECT_EQ(client.deadline(), now + 500ms);
  hears(rx({0xA4, 0x50, 0x1F, 0x01, 0x7F}));  // late answer of the abandoned transfer
  EXPECT_FALSE(client.take_no_block()) << "it may be mute altogether";
  hears(rx({0x60, 0x50, 0x1F, 0x01}));
  const auto reported = client.take_no_block();
  ASSERT_TRUE(reported);
  EXPECT_EQ(reported->object, (ObjectKey{0x1F50, 1}));
  EXPECT_EQ(reported->abort_code, 0U);
  EXPECT_FALSE(client.take_no_block());
  for (int i = 0; i < 19; ++i) {
    const bool toggle = i % 2 != 0;
    sends_some(1);
    hears(rx({static_cast<std::uint8_t>(toggle ? 0x30 : 0x20)}));
  }
  EXPECT_EQ(client.take_result()->size, 128U);
  download(128);
  sends(tx({0x21, 0x50, 0x1F, 0x01, 0x80}));  // the client has learnt that
  client.drop();                              // a reset
  download(128);
  sends(tx({0xC6, 0x50, 0x1F, 0x01, 0x80}));
}

TEST_F(SdoClientFallback, GoesBySegmentsWhereAnUploadFindsNoAnswer) {
  client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
  sends_some(1);
  now += 500ms;
  sends(tx({0x80, 0x21, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  sends(tx({0x40, 0x21, 0x10, 0x00}));
  hears(rx({0xC6, 0x21, 0x10, 0x00, 0x80}));  // late
  hears(rx({0x80, 0x21, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.take_result());
  EXPECT_EQ(client.take_no_block()->abort_code, 0x0504'0001U);
  hears(rx({0x4F, 0x21, 0x10, 0x00, 0x07}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
  EXPECT_FALSE(client.take_no_block());
}

TEST_F(SdoClientFallback, FallsBackOnceAndLearnsNothingFromAMuteServer) {
  for (int i = 0; i < 2; ++i) {
    client.upload({0x1021, 0}, buffer, 500ms, SdoMode::block);
    sends(tx({0xA4, 0x21, 0x10, 0x00, 0x7F, 0x1C}));
    now += 500ms;
    sends_some(1);
    sends(tx({0x40, 0x21, 0x10, 0x00}));
    now += 500ms;
    sends(tx({0x80, 0x21, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
    EXPECT_EQ(client.take_result()->fault, SdoFault::timeout);
    EXPECT_FALSE(client.take_no_block());
    sends_nothing();
  }
}

TEST_F(SdoClientFallback, CanBeCancelledBetweenBlockAndSegments) {
  download(128);
  sends_some(1);
  now += 500ms;
  sends_some(1);
  client.cancel();
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends(tx({0x80, 0x50, 0x1F, 0x01, 0x00, 0x00, 0x00, 0x08}));
  sends_nothing();
}

TEST_F(SdoClientFallback, ReportsOnceThatTheServerRefusesBlock) {
  download(128);
  sends_some(1);
  hears(rx({0x80, 0x50, 0x1F, 0x01, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_EQ(client.take_no_block()->abort_code, 0x0504'0001U);
  EXPECT_FALSE(client.take_no_block());
}

}  // namespace
}  // namespace takt
