#include "master/rt/request_router.hpp"

#include <gtest/gtest.h>

#include "master/rt/stop/stop_control.hpp"
#include "test/unit/master/rt/parts_rig.hpp"

namespace takt {
namespace {

struct RequestRouterTest : testing::Test {
  /// Returns the ids of all replies that the front thread has received.
  std::vector<std::uint64_t> replies() {
    std::vector<std::uint64_t> ids;
    for (Reply reply; parts.exchange->replies.pop(reply);) ids.push_back(reply.id);
    return ids;
  }
  void ask(std::uint64_t id, RequestKind kind = RequestKind::sdo_upload) {
    parts.exchange->requests.push({.id = id, .kind = kind, .node = 1, .object = {1, 0}});
  }

  Parts parts;
  DirectLink front{*parts.exchange};
  StopControl<FakeNetwork> stop{parts.bus};
  RequestRouter<FakePort, DirectLink, FakeNetwork> router{parts.port, front, parts.bus,
                                                          stop.stops()};
};

TEST_F(RequestRouterTest, BringsARequestToTheServicesAndItsReplyBack) {
  ask(7);
  router.take_request();
  ASSERT_EQ(parts.bus.services.submitted.size(), 1U);
  router.give_replies();
  EXPECT_EQ(replies(), std::vector<std::uint64_t>{7});
}

TEST_F(RequestRouterTest, CancelsWhatTheServicesDoNotAccept) {
  parts.bus.services.refuse = true;
  ask(7);
  router.take_request();
  EXPECT_FALSE(router.idle());
  router.give_replies();
  Reply reply;
  ASSERT_TRUE(parts.exchange->replies.pop(reply));
  EXPECT_EQ(reply.id, 7U);
  EXPECT_EQ(reply.fault, SdoFault::cancelled);
}

TEST_F(RequestRouterTest, TakesNoRequestWhileAReplyWaitsForRoom) {
  for (std::uint64_t id = 1; id <= 17; ++id) parts.bus.services.replies.push_back({.id = id});
  router.give_replies();
  EXPECT_FALSE(router.idle());
  ask(99);
  router.take_request();
  EXPECT_TRUE(parts.bus.services.submitted.empty());

  EXPECT_EQ(replies().size(), 16U);
  router.give_replies();
  EXPECT_EQ(replies(), std::vector<std::uint64_t>{17});
  router.take_request();
  EXPECT_EQ(parts.bus.services.submitted.size(), 1U);
}

TEST_F(RequestRouterTest, KeepsTheRepliesToPartsOfTheLoopFromTheFrontThread) {
  parts.bus.services.replies.push_back({.id = FallbackWriter::request_id});
  parts.bus.services.replies.push_back({.id = 5});
  router.give_replies();
  EXPECT_EQ(replies(), std::vector<std::uint64_t>{5});
}

TEST_F(RequestRouterTest, BeginsNoPdoRequestDuringAnOrderedStop) {
  parts.exchange->stop_requested = true;
  stop.step(front, 10s);
  ask(7, RequestKind::pdo_poll);
  router.take_request();
  router.give_replies();
  EXPECT_EQ(replies(), std::vector<std::uint64_t>{7});
  EXPECT_TRUE(parts.bus.pdo_requests.idle());
}

}  // namespace
}  // namespace takt
