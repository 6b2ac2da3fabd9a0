#include "master/core/node/node_watch.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

TEST(NodeWatch, IsArmedByTheFirstHeartbeatOnly) {
  NodeWatch watch{150ms};
  NodeStatus status;
  EXPECT_EQ(watch.deadline(), never);
  EXPECT_FALSE(watch.on_time(100s, status));
  EXPECT_EQ(watch.on_heartbeat(NmtState::preoperational, 100s, status), NodeWatch::Sign::new_state);
  EXPECT_EQ(watch.deadline(), 100s + 150ms);
}

TEST(NodeWatch, ReportsSilenceOnce) {
  NodeWatch watch{150ms};
  NodeStatus status;
  watch.on_heartbeat(NmtState::operational, 1s, status);
  EXPECT_FALSE(watch.on_time(1s + 150ms - 1ns, status));
  EXPECT_EQ(watch.on_time(1s + 150ms, status), Time{150ms});
  EXPECT_FALSE(watch.on_time(100s, status));
  EXPECT_EQ(status.nmt, NmtState::unknown);
  EXPECT_EQ(status.heartbeat_lost, 1U);
  EXPECT_EQ(watch.on_heartbeat(NmtState::operational, 100s, status), NodeWatch::Sign::new_state);
  EXPECT_EQ(watch.deadline(), 100s + 150ms);
}

TEST(NodeWatch, CountsNoSilenceWhileTheMasterWasAway) {
  NodeWatch watch{150ms};
  NodeStatus status;
  watch.extend_deadlines(300ms);
  EXPECT_EQ(watch.deadline(), never);
  watch.on_heartbeat(NmtState::operational, 1s, status);
  watch.extend_deadlines(300ms);
  EXPECT_FALSE(watch.on_time(1s + 450ms - 1ns, status));
  EXPECT_TRUE(watch.on_time(1s + 450ms, status));
}

TEST(NodeWatch, TakesABootUpMessageAsNoHeartbeat) {
  NodeWatch watch{150ms};
  NodeStatus status;
  watch.on_heartbeat(NmtState::operational, 1s, status);
  EXPECT_EQ(watch.on_heartbeat(NmtState::bootup, 2s, status), NodeWatch::Sign::bootup);
  EXPECT_EQ(watch.deadline(), never);
  EXPECT_EQ(status.last_heartbeat, Time{1s});
}

TEST(NodeWatch, WatchesNobodyWithoutATime) {
  NodeWatch watch{0ms};
  NodeStatus status;
  watch.on_heartbeat(NmtState::operational, 1s, status);
  EXPECT_EQ(watch.deadline(), never);
  EXPECT_EQ(status.nmt, NmtState::operational);
}

}  // namespace
}  // namespace takt
