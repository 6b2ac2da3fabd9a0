#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/print_budget.hpp"
#include "test/budget/hand_made_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

BudgetRow row_of(const BusBudget& budget, std::string_view name) {
  const auto found = std::ranges::find_if(
      budget.rows, [&](const BudgetRow& row) { return row.frame.name == name; });
  return found == budget.rows.end() ? BudgetRow{} : *found;
}

NodeId master_of(const BusPlan& plan) { return plan.master_id; }

BusPlan with_heartbeat_of_the_master(Time period) {
  auto plan = hand_made_bus(2, 2ms);
  plan.master_heartbeat = period;
  return plan;
}

TEST(BudgetLimits, TheMastersHeartbeatHasTheTimeOfItsLeastPatientConsumer) {
  auto plan = with_heartbeat_of_the_master(100ms);
  plan.nodes[0].watches = {{.producer = master_of(plan), .longest = 300ms}};
  plan.nodes[1].watches = {{.producer = plan.nodes[0].id, .longest = 120ms},
                           {.producer = master_of(plan), .longest = 250ms}};

  const auto row = row_of(bus_budget(plan), "heartbeat master");

  EXPECT_EQ(row.why, BudgetLimit::timeout);
  EXPECT_EQ(row.limit, 150ms);
  EXPECT_EQ(row.frame.waits, "n2 (0x1016)");
}

TEST(BudgetLimits, AHeartbeatThatNobodyConsumesHasNoLimit) {
  const auto budget = bus_budget(with_heartbeat_of_the_master(100ms));

  for (const auto* name : {"heartbeat master", "heartbeat n1"}) {
    EXPECT_EQ(row_of(budget, name).why, BudgetLimit::none) << name;
    EXPECT_TRUE(row_of(budget, name).fits()) << name;
  }
}

TEST(BudgetLimits, AHeartbeatMayBeLaterThanItsPeriodIfItsConsumerWaits) {
  auto plan = with_heartbeat_of_the_master(1ms);
  plan.nodes[0].watches = {{.producer = master_of(plan), .longest = 100ms}};

  const auto row = row_of(bus_budget(plan), "heartbeat master");

  EXPECT_GT(row.worst, 1ms);
  EXPECT_TRUE(row.fits());
}

TEST(BudgetLimits, AConsumerThatWaitsNoLongerThanThePeriodMissesTheMaster) {
  auto plan = with_heartbeat_of_the_master(100ms);
  plan.nodes[1].watches = {{.producer = master_of(plan), .longest = 100ms}};
  const auto budget = bus_budget(plan);

  EXPECT_FALSE(row_of(budget, "heartbeat master").fits());
  std::ostringstream text;
  print_budget_text(text, plan, budget);
  EXPECT_THAT(text.str(), HasSubstr("the wait for it by n2 (0x1016) ends at 0 us"));
}

TEST(BudgetLimits, ADevicesHeartbeatIsAwaitedByTheMasterAndByDevices) {
  auto plan = hand_made_bus(2, 2ms);
  plan.nodes[0].heartbeat_timeout = plan.nodes[1].heartbeat_timeout = 300ms;
  plan.nodes[1].watches = {{.producer = plan.nodes[0].id, .longest = 120ms}};
  const auto budget = bus_budget(plan);

  EXPECT_EQ(row_of(budget, "heartbeat n1").limit, 20ms);
  EXPECT_EQ(row_of(budget, "heartbeat n1").frame.waits, "n2 (0x1016)");
  EXPECT_EQ(row_of(budget, "heartbeat n2").limit, 200ms);
  EXPECT_EQ(row_of(budget, "heartbeat n2").frame.waits, "the master");
  std::ostringstream json;
  print_budget_json(json, plan, budget, {});
  EXPECT_THAT(json.str(), HasSubstr("\"limit_by\": \"n2 (0x1016)\""));
}

/// Makes a bus at 1 Mbit/s without SYNC, with one node without PDOs that is guarded every 100 ms,
/// and with one SDO dialogue in 10 ms.
BusPlan guarded() {
  BusPlan plan{.name = "guarded"};
  plan.cycle.sync = false;
  plan.cycle.period = 10ms;
  plan.nodes.push_back({.name = "n1", .id = *NodeId::from(1)});
  plan.nodes[0].guard = {.period = 100ms, .retries = 3};
  plan.nodes[0].sdo_timeout = 500ms;
  compile(plan);
  plan.cycle.service_frames = 1;
  return plan;
}

TEST(BudgetLimits, TheAnswerToGuardingHasWhatItsRequestLeaves) {
  const auto budget = bus_budget(guarded());

  // NMT (75 bits), two SDO dialogues (270 each), an answer (65), and the request itself (55).
  EXPECT_EQ(row_of(budget, "guard request n1").worst, 735us);
  EXPECT_EQ(row_of(budget, "guard request n1").why, BudgetLimit::none);
  EXPECT_EQ(row_of(budget, "guarding n1").limit, 300ms - 100ms - 735us);
  EXPECT_EQ(row_of(budget, "guarding n1").frame.waits, "the master");
}

TEST(BudgetLimits, LifeGuardingOfTheDeviceLimitsTheRequest) {
  auto plan = guarded();
  plan.nodes[0].life_guarding = 150ms;

  const auto row = row_of(bus_budget(plan), "guard request n1");

  EXPECT_EQ(row.limit, 50ms);
  EXPECT_EQ(row.frame.waits, "n1 (0x100D)");
}

TEST(BudgetLimits, AnSdoAnswerHasWhatItsRequestLeavesOfTheTimeOut) {
  const auto budget = bus_budget(guarded());

  // Waits for a guarding answer that has begun (65), NMT (75), and two answers (135 each). A round
  // may be late by one round (10 ms).
  EXPECT_EQ(row_of(budget, "SDO requests").worst, 10ms + 65us + 75us + 270us + 135us);
  EXPECT_EQ(row_of(budget, "SDO requests").limit, 500ms);
  EXPECT_EQ(row_of(budget, "SDO answers").limit, 500ms - 10ms - 545us);
}

TEST(BudgetLimits, WhatTaktdRefusesIsDeclaredInTextAndJson) {
  // SYNC 55, four TPDOs 540, four RPDOs 540, and the quiet time of 135 + 20: 1290 us.
  const auto plan = hand_made_bus(4, 1ms);
  const auto budget = bus_budget(plan);

  EXPECT_TRUE(budget.refused);
  std::ostringstream text;
  print_budget_text(text, plan, budget);
  EXPECT_THAT(text.str(),
              HasSubstr("\n  SYNC and TPDOs (595 us), RPDOs (540 us) and the quiet before SYNC "
                        "(155 us) need more"));
  EXPECT_THAT(text.str(), testing::StartsWith("It does not fit"));
  std::ostringstream json;
  print_budget_json(json, plan, budget, {});
  EXPECT_THAT(json.str(), HasSubstr("\"fits\": false,\n  \"refused_by_taktd\": true"));
}

TEST(BudgetLimits, ARefusedNetworkDoesNotFitThoughEveryFrameIsInTime) {
  auto budget = bus_budget(hand_made_bus(2, 2ms));
  ASSERT_TRUE(budget.fits());
  budget.refused = true;

  EXPECT_FALSE(budget.fits());
  EXPECT_FALSE(budget.fits_in_burst());
  EXPECT_FALSE(budget.fits_but_for_changes());
}

TEST(BudgetLimits, TheBudgetRefusesWhatTheCompilerOfTheNetworkRefuses) {
  for (Time period = 400us; period < 2ms; period += 10us) {
    auto plan = hand_made_bus(3, period);
    Findings findings;
    NetworkReport report{"test", findings};
    compile_cycle(NetworkSpec{}, {}, plan, report);

    EXPECT_EQ(bus_budget(plan).refused, has_error(findings)) << period.count();
  }
}

}  // namespace
}  // namespace takt
