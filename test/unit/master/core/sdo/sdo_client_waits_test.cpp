// Time-outs, late answers, and transfers that are cancelled.
#include <gtest/gtest.h>

#include "test/unit/master/core/sdo/sdo_client_rig.hpp"

namespace takt {
namespace {

TEST_F(SdoClientTest, IsOwedAnAnswerFromItsRequestToTheAnswerOrTheTimeOut) {
  upload({0x1008, 0});
  EXPECT_FALSE(client.awaits_answer());
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  EXPECT_TRUE(client.awaits_answer());
  hears(rx({0x41, 0x08, 0x10, 0x00, 0x0A}));
  EXPECT_FALSE(client.awaits_answer());
  sends(tx({0x60}));
  EXPECT_TRUE(client.awaits_answer());

  now += 501ms;
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_FALSE(client.awaits_answer());
}

TEST_F(SdoClientTest, AbortsOnTheBusWhenTheDeviceStaysSilent) {
  download({0x1017, 0}, bytes({0xE8, 0x03}));
  EXPECT_EQ(client.deadline(), at_once);
  sends(tx({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
  EXPECT_EQ(client.deadline(), 1500ms);

  now = 1500ms - 1ns;
  sends_nothing();
  now = 1500ms;
  sends(tx({0x80, 0x17, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));

  const auto result = client.take_result();
  EXPECT_EQ(result->fault, SdoFault::timeout);
  EXPECT_EQ(result->abort_code, 0x05040000U);
}

TEST_F(SdoClientTest, GivesEachSegmentItsOwnTime) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  for (int i = 0; i < 4; ++i) {
    now += 499ms;
    hears(i == 0
              ? rx({0x40, 0x08, 0x10, 0x00})
              : (i % 2 == 1 ? rx({0x00, 1, 2, 3, 4, 5, 6, 7}) : rx({0x10, 1, 2, 3, 4, 5, 6, 7})));
    sends(i % 2 == 0 ? tx({0x60}) : tx({0x70}));
  }
  now += 500ms;
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
}

TEST_F(SdoClientTest, IgnoresTheLateAnswerOfAnEarlierRequest) {
  upload({0x1018, 1});
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  now += 500ms;
  sends(tx({0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x04, 0x05}));
  client.take_result();
  upload({0x1018, 2});
  sends(tx({0x40, 0x18, 0x10, 0x02}));

  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));  // late answer
  hears(rx({0x80, 0x18, 0x10, 0x01, 0x00, 0x00, 0x04, 0x05}));  // late abort
  hears(rx({0x00, 1, 2, 3, 4, 5, 6, 7}));                       // late segment
  hears(rx({0x20}));                                            // late confirmation
  hears(rx({0x60, 0x18, 0x10, 0x02}));                          // confirmation of a download
  EXPECT_FALSE(client.take_result());
  EXPECT_EQ(client.deadline(), now + 500ms);  // unrelated frames do not extend the wait

  hears(rx({0x43, 0x18, 0x10, 0x02, 0x07, 0x00, 0x00, 0x00}));
  EXPECT_EQ(client.take_result()->fault, SdoFault::none);
  EXPECT_EQ(buffer[0], std::byte{7});
}

TEST_F(SdoClientTest, IgnoresAnswersBeforeItsRequestIsSent) {
  upload({0x1018, 1});
  hears(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}));
  EXPECT_FALSE(client.take_result());
  sends(tx({0x40, 0x18, 0x10, 0x01}));
}

TEST_F(SdoClientTest, SaysOnTheBusWhenItIsCancelled) {
  upload({0x1008, 0});
  sends(tx({0x40, 0x08, 0x10, 0x00}));
  client.cancel();
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends(tx({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x00, 0x08}));
  EXPECT_TRUE(client.idle());
}

TEST_F(SdoClientTest, SaysNothingWhenItIsCancelledBeforeItsRequestWasSent) {
  upload({0x1008, 0});
  client.cancel();
  EXPECT_EQ(client.take_result()->fault, SdoFault::cancelled);
  sends_nothing();
}

TEST_F(SdoClientTest, ComesBackWhenTheOutboxIsFull) {
  upload({0x1018, 1});
  Outbox full;
  full.set_limit(0);
  client.on_time(now, full);
  EXPECT_EQ(client.deadline(), at_once);
  now += 10s;
  sends(tx({0x40, 0x18, 0x10, 0x01}));
  EXPECT_EQ(client.deadline(), now + 500ms);
}

}  // namespace
}  // namespace takt
