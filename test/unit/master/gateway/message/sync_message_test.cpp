#include <gtest/gtest.h>

#include "master/gateway/message/bus_view.hpp"
#include "master/gateway/message/status_messages.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

BusPlan followed() {
  BusPlan plan;
  plan.name = "lift";
  plan.cycle.period = 10ms;
  plan.cycle.sync_followed = true;
  plan.cycle.sync_timeout = 15ms;
  plan.cycle.sync_producer = 3_node;
  plan.nodes.push_back({.name = "conveyor", .id = 3_node});
  return plan;
}

BusStatus in(SyncState state) {
  BusStatus bus;
  bus.sync = state;
  return bus;
}

TEST(SyncMessage, ReportsWhomTheCycleIsLockedTo) {
  BusStatus bus = in(SyncState::locked);
  bus.beats = 77;
  bus.sync_losses = 2;
  bus.sync_period = 10'001'250ns;

  const sync_status_t message = sync_message(followed(), bus);

  EXPECT_EQ(message.state, 3);
  EXPECT_EQ(message.source, "conveyor");
  EXPECT_EQ(message.node_id, 3);
  EXPECT_EQ(message.period_ns, 10'001'250);
  EXPECT_EQ(message.declared_ns, 10'000'000);
  EXPECT_EQ(message.timeout_ns, 15'000'000);
  EXPECT_EQ(message.syncs, 77);
  EXPECT_EQ(message.losses, 2);
  EXPECT_EQ(message.text, "locked to the SYNC of conveyor (node 3), 10.001 ms");
}

TEST(SyncMessage, HasWordsForEveryState) {
  BusPlan plan = followed();
  EXPECT_EQ(sync_message(plan, in(SyncState::awaited)).text,
            "waits for the first SYNC of conveyor (node 3)");
  EXPECT_EQ(sync_message(plan, in(SyncState::lost)).text, "SYNC of conveyor (node 3) LOST");
  plan.cycle.sync_producer.reset();
  EXPECT_EQ(sync_message(plan, in(SyncState::lost)).text,
            "SYNC of a device that is not in the network file LOST");
  EXPECT_EQ(sync_message(plan, in(SyncState::lost)).source, "external");
  plan.cycle.sync_followed = false;
  const sync_status_t made = sync_message(plan, in(SyncState::made));
  EXPECT_EQ(made.text, "produced by the master, 10.000 ms");
  EXPECT_EQ(made.source, "master");
  EXPECT_EQ(made.timeout_ns, 0);
  plan.cycle.sync = false;
  EXPECT_EQ(sync_message(plan, in(SyncState::none)).source, "");
}

TEST(SyncMessage, ReachesAView) {
  std::vector<std::byte> buffer;
  BusViews views;

  EXPECT_EQ(
      views.take("LIFT_SYNC", encode(sync_message(followed(), in(SyncState::locked)), buffer)), "");

  ASSERT_TRUE(views.buses().contains("LIFT"));
  ASSERT_TRUE(views.buses().find("LIFT")->second.sync().has_value());
  EXPECT_EQ(views.buses().find("LIFT")->second.sync()->source, "conveyor");
}

}  // namespace
}  // namespace takt
