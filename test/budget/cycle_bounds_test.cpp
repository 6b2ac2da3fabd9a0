#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/budget/budget.hpp"
#include "test/budget/hand_made_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Returns the ends of SYNC and the PDOs in order of priority.
std::vector<std::int64_t> latest_us(const BusBudget& budget) {
  std::vector<std::int64_t> out;
  for (const auto& row : budget.rows) {
    if (row.frame.in_cycle) out.push_back(row.worst ? row.worst->count() / 1000 : -1);
  }
  return out;
}

// SYNC takes 55 bits, a PDO and an SDO answer 135 each; the outputs are sent at 2000 - 135 - 40 -
// 270.

TEST(CycleBounds, ASdoAnswerMayHaveBegunBeforeSyncBeforeTheInputsAndBeforeTheOutputs) {
  const auto budget = bus_budget(hand_made_bus(2, 2ms), {.device_time = 30us});

  EXPECT_THAT(latest_us(budget),
              ElementsAre(135 + 55, 190 + 30 + 135 + 135, 490 + 135, 1555 + 135 + 135, 1825 + 135));
  EXPECT_TRUE(budget.fits());
}

TEST(CycleBounds, OnlyTheMastersOwnFramesComeBetweenSyncAndDevicesThatAnswerAtOnce) {
  const auto budget = bus_budget(hand_made_bus(2, 2ms), {.device_time = 0us});

  EXPECT_THAT(latest_us(budget), ElementsAre(190, 75 + 325, 75 + 460, 1825, 1960));
}

TEST(CycleBounds, TpdosByTurnsDoNotWaitForEachOther) {
  auto plan = hand_made_bus(2, 2ms);
  plan.cycle.sync_overflow = 4;  // SYNC of one byte: 65 bits
  for (std::uint8_t i = 0; i < 2; ++i) {
    plan.pdos.tpdos[i].transmission = 2;
    plan.pdos.tpdos[i].sync_start = i + 1;
  }

  EXPECT_THAT(latest_us(bus_budget(plan, {.device_time = 30us})),
              ElementsAre(200, 500, 500, 1825, 1960));
}

TEST(CycleBounds, TurnsOfACounterThatDoesNotDivideAreNotCertain) {
  auto plan = hand_made_bus(2, 2ms);
  plan.cycle.sync_overflow = 5;
  for (std::uint8_t i = 0; i < 2; ++i) {
    plan.pdos.tpdos[i].transmission = 2;
    plan.pdos.tpdos[i].sync_start = i + 1;
  }

  EXPECT_THAT(latest_us(bus_budget(plan, {.device_time = 30us})),
              ElementsAre(200, 500, 635, 1825, 1960));
}

TEST(CycleBounds, AnErrorCostsItsFrameAnd31Bits) {
  const auto budget = bus_budget(hand_made_bus(2, 2ms), {.device_time = 30us, .errors = {1, 10ms}});

  EXPECT_THAT(latest_us(budget),
              ElementsAre(190 + 31 + 75, 490 + 166, 625 + 166, 1825 + 166, 1960 + 166));
}

TEST(CycleBounds, EmcysOfAllNodesAtOnceAreAColumnOfTheirOwn) {
  const auto budget = bus_budget(hand_made_bus(2, 2ms), {.device_time = 30us});

  EXPECT_EQ(budget.rows[1].frame.name, "SYNC");
  EXPECT_EQ(budget.rows[4].frame.name, "TPDO1 n1");
  EXPECT_EQ(budget.rows[4].worst_in_burst, 490us + 2 * 135us);
  EXPECT_TRUE(budget.fits());
  EXPECT_FALSE(budget.fits_in_burst());  // the last RPDO at 2230 us delays SYNC by more than 200
}

/// Gives each node a second TPDO and a second RPDO, both sent on change.
BusPlan with_events(std::uint8_t nodes, Time period) {
  auto plan = hand_made_bus(nodes, period);
  for (auto* rows : {&plan.pdos.tpdos, &plan.pdos.rpdos}) {
    for (std::uint8_t i = 0; i < nodes; ++i) {
      auto row = (*rows)[i];
      row.cob_id = CobId::base(row.cob_id.id() + 0x100);
      row.number = 2;
      row.transmission = 255;
      row.inhibit = 10ms;
      rows->push_back(row);
    }
  }
  compile(plan);
  return plan;
}

TEST(CycleBounds, OutputsThatAreLateOnlyWhileAllEventDrivenOnesChangeFitWithAWarning) {
  const auto budget = bus_budget(with_events(2, 2ms), {.device_time = 30us});

  // From 1285 us: a frame that has begun, four outputs, and two TPDOs that go before the last two
  // outputs. SYNC may be 200 us late.
  const auto& last = budget.rows[11];
  EXPECT_EQ(last.frame.name, "RPDO2 n2");
  EXPECT_EQ(last.worst, 1285us + 135us + 2 * 135us + 4 * 135us);
  EXPECT_EQ(last.worst_steady, 1285us + 135us + 2 * 135us);
  EXPECT_TRUE(last.is_late_by_changes_only());
  EXPECT_TRUE(budget.fits());
  EXPECT_TRUE(budget.fits_but_for_changes());
}

TEST(CycleBounds, ALateOutputMayHaveBegunBeforeTheSyncOfAnotherDevice) {
  auto plan = hand_made_bus(2, 4ms);
  plan.cycle.sync_followed = true;
  plan.pdos.rpdos[1].cob_id = CobId::extended(0x500U << 18);  // 160 bits
  compile(plan);

  EXPECT_EQ(latest_us(bus_budget(plan))[0], 160 + 55);
}

TEST(CycleBounds, LateAnswersHoldUpServiceFramesAndTheOutputsBehindThem) {
  auto plan = hand_made_bus(3, 4ms);  // outputs at 4000 - 135 - 80 - 405
  plan.cycle.service_frames = 3;
  const auto budget = bus_budget(plan, {.device_time = 30us});

  // NMT (75) and three requests (405) are queued so that on a free bus they end before 3380, with
  // the same time for their answers. Each of three nodes has a late answer (405), and a heartbeat
  // has begun.
  const auto services = 3380us - 480us + 2 * 405us + 65us;
  EXPECT_EQ(budget.rows[10].frame.name, "RPDO1 n3");
  EXPECT_EQ(budget.rows[10].worst, 3380us + 135us + 3 * 135us);
  EXPECT_EQ(budget.rows[10].worst_behind_services, services + 3 * 135us);
  EXPECT_EQ(budget.sync_delay_behind_services(), services + 3 * 135us + 55us - 4000us - 190us);
}

TEST(CycleBounds, OneNodeOwesOneAnswer) {
  auto plan = hand_made_bus(1, 4ms);
  plan.cycle.service_frames = 8;

  const auto budget = bus_budget(plan, {.device_time = 30us});

  EXPECT_EQ(budget.rows[4].frame.name, "RPDO1 n1");
  EXPECT_EQ(budget.rows[4].worst_behind_services, budget.rows[4].worst);
}

TEST(CycleBounds, ATpdoThatIsLateMayHaveBegunBeforeTheNextSync) {
  auto plan = hand_made_bus(1, 320us);
  plan.pdos.rpdos.clear();
  plan.pdos.tpdos[0].cob_id = CobId::extended(0x181U << 18);  // 160 bits
  compile(plan);

  EXPECT_EQ(latest_us(bus_budget(plan))[0], 160 + 55);
  plan.cycle.period = 2ms;
  compile(plan);
  EXPECT_EQ(latest_us(bus_budget(plan))[0], 135 + 55);
}

TEST(CycleBounds, AnNmtFrameRightBehindSyncMayMeetTheNextOneOnlyIfThePeriodIsThatShort) {
  auto plan = hand_made_bus(1, 73us);
  plan.pdos = {};
  compile(plan);

  EXPECT_EQ(latest_us(bus_budget(plan))[0], 135 + 75 + 55);
  plan.cycle.period = 135us + 55us + 75us;
  compile(plan);
  EXPECT_EQ(latest_us(bus_budget(plan))[0], 135 + 55);
}

TEST(CycleBounds, ACycleThatNeedsMoreThanTheBusHasNoBounds) {
  const auto budget = bus_budget(hand_made_bus(8, 2ms));

  EXPECT_EQ(latest_us(budget), std::vector<std::int64_t>(17, -1));
  EXPECT_FALSE(budget.fits());
}

TEST(BusLoad, IsThatOfSyncPdosAndHeartbeats) {
  auto plan = hand_made_bus(2, 2ms);
  const auto load = bus_budget(plan).load;

  // (55 + 4 * 135) / 2000 + 2 * 65 / 100000, and (49 + 4 * 120.2) / 2000 + 2 * 57.9 / 100000
  EXPECT_NEAR(load.worst, 0.2975 + 0.0013, 1e-9);
  EXPECT_NEAR(load.typical, 0.2649 + 0.001158, 1e-9);
}

}  // namespace
}  // namespace takt
