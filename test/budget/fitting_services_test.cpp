#include <gtest/gtest.h>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/suggestions.hpp"
#include "test/budget/changed_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Makes a bus whose heartbeats come in time only if SDO leaves time for them.
BusPlan with_urgent_heartbeats() {
  auto plan = hand_made_bus(120, 80ms);
  for (NodePlan& node : plan.nodes) node.heartbeat_timeout = 300ms;
  plan.cycle.service_frames = 32;
  return plan;
}

bool fits_with(BusPlan plan, std::uint16_t frames) {
  plan.cycle.service_frames = frames;
  return bus_fits(plan);
}

TEST(FittingServices, AreTheMostWithWhichEverythingFits) {
  const BusPlan plan = with_urgent_heartbeats();
  ASSERT_FALSE(bus_fits(plan));

  const auto frames = fitting_service_frames(plan);

  ASSERT_TRUE(frames);
  EXPECT_GT(*frames, 1);
  EXPECT_TRUE(fits_with(plan, *frames));
  EXPECT_FALSE(fits_with(plan, static_cast<std::uint16_t>(*frames + 1)));
}

TEST(FittingServices, StayAsTheyAreWhereTheyFit) {
  const auto plan = hand_made_bus(4, 10ms);
  ASSERT_TRUE(bus_fits(plan));

  EXPECT_EQ(fitting_service_frames(plan), plan.cycle.service_frames);
}

TEST(FittingServices, AreNoneWhereTheCycleItselfIsTooLong) {
  EXPECT_EQ(fitting_service_frames(hand_made_bus(4, 1ms)), std::nullopt);
}

TEST(Suggestions, FewerServiceFramesAreTheFirst) {
  const BusPlan plan = with_urgent_heartbeats();
  const auto frames = fitting_service_frames(plan);
  ASSERT_TRUE(frames);

  const auto found =
      cheapest_changes(plan, {}, {}, [&](const WhatIf& changes) { return changed(plan, changes); });

  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].text, "`service_frames: " + std::to_string(*frames) + "` instead of 32");
  EXPECT_EQ(to_string(found[0].changes), "services=" + std::to_string(*frames));
}

}  // namespace
}  // namespace takt
