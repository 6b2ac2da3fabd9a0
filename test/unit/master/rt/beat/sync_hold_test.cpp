#include "master/rt/beat/sync_hold.hpp"

#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace takt {
namespace {

/// Makes the plan of one node with these steps of its boot, and a SYNC with counter.
BusPlan plan_of(std::vector<BootStep> steps) {
  BusPlan plan;
  plan.cycle.sync_overflow = 10;
  plan.nodes.push_back({.name = "axis", .id = 1_node});
  plan.nodes[0].boot_plan.steps = std::move(steps);
  return plan;
}

/// Returns true if SYNC is permitted while the node boots and is at this step.
bool open_at(const BusPlan& plan, std::size_t step) {
  std::vector<NodeStatus> nodes(1);
  nodes[0].boot = BootState::booting;
  nodes[0].boot_step = static_cast<decltype(nodes[0].boot_step)>(step);
  return SyncHold{plan}.open(nodes);
}

const BootStep write_step{.action = BootAction::write};
const BootStep first_heartbeat{.action = BootAction::await_heartbeat};
const BootStep start_node{.action = BootAction::nmt, .command = NmtCommand::start};

TEST(SyncHold, EndsWhenTheNodeHasOnlyItsFirstHeartbeatBeforeTheStart) {
  const BusPlan plan = plan_of({write_step, write_step, first_heartbeat, start_node});
  EXPECT_FALSE(open_at(plan, 0));
  EXPECT_FALSE(open_at(plan, 1));
  EXPECT_TRUE(open_at(plan, 2));
}

TEST(SyncHold, EndsAtTheStartOfANodeWithoutAHeartbeat) {
  const BusPlan plan = plan_of({write_step, write_step, start_node});
  EXPECT_FALSE(open_at(plan, 1));
  EXPECT_TRUE(open_at(plan, 2));
}

}  // namespace
}  // namespace takt
