#include "eds_parser/budget/traffic.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/budget/budget.hpp"
#include "test/budget/hand_made_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TrafficFrame frame_of(const BusTraffic& traffic, std::string_view name) {
  const auto found = std::ranges::find(traffic.frames, name, &TrafficFrame::name);
  return found == traffic.frames.end() ? TrafficFrame{} : *found;
}

/// Makes a bus with SYNC every 10 ms and one node with a TPDO of type 255.
BusPlan by_event(Time inhibit, Time event_timer) {
  auto plan = hand_made_bus(1, 10ms);
  auto& tpdo = plan.pdos.tpdos[0];
  tpdo.transmission = 255;
  tpdo.inhibit = inhibit;
  tpdo.event_timer = event_timer;
  return plan;
}

Time period_of_tpdo(Time inhibit, Time event_timer) {
  return frame_of(bus_traffic(by_event(inhibit, event_timer), {}), "TPDO1 n1").period;
}

TEST(BudgetTraffic, AnEventTimerSendsMoreOftenThanOnceACycleButNotWithinTheInhibitTime) {
  EXPECT_EQ(period_of_tpdo(0ms, 1ms), 1ms);
  EXPECT_EQ(period_of_tpdo(0ms, 25ms), 10ms);
  EXPECT_EQ(period_of_tpdo(3ms, 1ms), 3ms);
  EXPECT_EQ(period_of_tpdo(3ms, 25ms), 3ms);
}

TEST(BudgetTraffic, WhatAnEventTimerSendsIsNotCountedOnceACycle) {
  const auto traffic = bus_traffic(by_event(0ms, 1ms), {});

  EXPECT_FALSE(frame_of(traffic, "TPDO1 n1").period_assumed);
  EXPECT_EQ(frame_of(traffic, "TPDO1 n1").limit, 1ms);
  EXPECT_THAT(traffic.assumptions, Each(Not(HasSubstr("once per cycle"))));
  EXPECT_THAT(traffic.assumptions,
              Contains("no inhibit time: counted once per event timer, although the device may "
                       "also send at every change of a value: TPDO1 n1"));
}

TEST(BudgetTraffic, TypesOnRequestAreSentAsOftenAsTheMasterAsks) {
  auto plan = by_event(100ms, 1ms);
  plan.pdos.tpdos[0].transmission = 253;
  plan.pdos.tpdos[0].poll = 20ms;

  const auto traffic = bus_traffic(plan, {});

  EXPECT_EQ(frame_of(traffic, "TPDO1 n1").period, 20ms);
  EXPECT_EQ(frame_of(traffic, "request of TPDO1 n1").period, 20ms);
  EXPECT_EQ(frame_of(traffic, "answer of TPDO1 n1").bytes, 0);  // there is none
}

TEST(BudgetTraffic, AnEventDrivenTpdoThatIsPolledSendsItsEventsAndItsAnswers) {
  auto plan = by_event(3ms, 0ms);
  plan.pdos.tpdos[0].poll = 20ms;

  const auto budget = bus_budget(plan);

  const auto row = [&](std::string_view name) {
    return std::ranges::find(budget.rows, name, [](const BudgetRow& r) { return r.frame.name; });
  };
  EXPECT_EQ(row("TPDO1 n1")->frame.period, 3ms);
  EXPECT_EQ(row("answer of TPDO1 n1")->frame.period, 20ms);
  EXPECT_EQ(row("TPDO1 n1")->worst, row("answer of TPDO1 n1")->worst);
}

TEST(BudgetTraffic, EventTimersAloneCanOverfillABus) {
  // 135 us each and 8 of them: 108 % of 1 ms.
  auto plan = hand_made_bus(4, 10ms);
  for (std::uint8_t i = 0; i < 4; ++i) {
    auto row = plan.pdos.tpdos[i];
    row.cob_id = CobId::base(row.cob_id.id() + 0x100);
    row.number = 2;
    plan.pdos.tpdos.push_back(row);
  }
  for (auto& row : plan.pdos.tpdos) {
    row.transmission = 255;
    row.event_timer = 1ms;
  }
  compile(plan);

  const auto budget = bus_budget(plan);

  EXPECT_GT(budget.load.worst, 1.08);
  EXPECT_FALSE(budget.fits());
}

TEST(BudgetTraffic, TpdosThatTheMasterLeavesAloneAreReportedAsNotCounted) {
  const Findings findings{
      {"a.yaml", {3, 1}, Severity::note, "pdo-left-out", "TPDO3 of node `a` is valid in a.eds"},
      {"a.yaml", {3, 1}, Severity::note, "pdo-left-out", "RPDO3 of node `a` is valid in a.eds"},
      {"a.yaml", {3, 1}, Severity::note, "not-polled", "TPDO2 of node `a` has type 253"}};

  EXPECT_THAT(left_out_tpdos(findings),
              ElementsAre("not counted: TPDO3 of node `a` is valid in a.eds"));
}

}  // namespace
}  // namespace takt
