#include "apps/plot/motion/motion_trace.hpp"

#include <array>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using ::testing::HasSubstr;

constexpr double period = 0.002;

motion_t report(std::int64_t cycle, double position) {
  motion_t message{};
  message.session = 1;
  message.cycle = cycle;
  axis_motion_t axis{};
  axis.node_id = 5;
  axis.axis = 1;
  axis.position = position;
  axis.velocity = 1.0;
  axis.actual_position = position - 0.1;
  axis.following_error = 0.1;
  message.axes = {axis};
  message.num_axes = 1;
  return message;
}

const TracedAxis shoulder{.node_id = 5, .axis = 1, .name = "shoulder", .unit = "rad"};

TEST(MotionTrace, DrawsCommandedAndActualValues) {
  MotionTrace trace;
  for (int i = 0; i < 100; ++i) trace.take(report(i, i * period));
  const Plot plot = trace.plot("test", std::array{shoulder}, period);
  ASSERT_EQ(plot.panels.size(), 4U);
  EXPECT_EQ(plot.panels[0].quantity, "position");
  EXPECT_EQ(plot.panels[1].unit, "rad/s");
  EXPECT_EQ(plot.panels[2].unit, "rad/s²");
  EXPECT_EQ(plot.panels[3].quantity, "following error");
  ASSERT_EQ(plot.panels[0].curves.size(), 2U);
  EXPECT_NEAR(plot.panels[0].curves[0].values[50], 0.0, 1e-9) << "actual";
  EXPECT_NEAR(plot.panels[0].curves[1].values[50], 0.1, 1e-9) << "commanded";
  EXPECT_NEAR(plot.panels[1].curves[0].values[50], 1.0, 1e-6) << "0x606C is missing";
  EXPECT_NEAR(plot.panels[2].curves[0].values[50], 0.0, 1e-6);
  EXPECT_NEAR(plot.panels[3].curves[0].values[50], 0.1, 1e-9);
  EXPECT_NEAR(plot.times.back(), 99 * period, 1e-9);
}

TEST(MotionTrace, HasAPanelForEachUnit) {
  MotionTrace trace;
  motion_t both = report(1, 0.0);
  both.axes.push_back(both.axes.front());
  both.axes.back().node_id = 6;
  both.num_axes = 2;
  trace.take(both);
  const TracedAxis lift{.node_id = 6, .axis = 1, .name = "lift", .unit = "m"};
  const Plot plot = trace.plot("test", std::array{shoulder, lift}, period);
  ASSERT_EQ(plot.panels.size(), 8U);
  EXPECT_EQ(plot.panels[0].unit, "rad");
  EXPECT_EQ(plot.panels[1].unit, "m");
}

TEST(MotionTrace, HasBoundedMemory) {
  MotionTrace trace;
  constexpr int cycles = 10 * static_cast<int>(MotionTrace::most_cycles);
  for (int i = 0; i < cycles; ++i) trace.take(report(i, i * period));
  const Plot plot = trace.plot("test", std::array{shoulder}, period);
  EXPECT_LE(plot.times.size(), MotionTrace::most_cycles);
  EXPECT_EQ(plot.times.front(), 0.0);
  EXPECT_GT(plot.times.back(), (cycles - 32) * period) << "the end is not cut off";
  EXPECT_THAT(plot.note, HasSubstr("each 16th cycle"));
}

TEST(MotionTrace, TakesThePartsOfOneCycleTogether) {
  MotionTrace trace;
  trace.take(report(1, 0.0));
  motion_t second = report(1, 3.0);
  second.axes.front().node_id = 6;
  trace.take(second);
  const Plot plot = trace.plot("test", std::array{shoulder, TracedAxis{.node_id = 6}}, period);
  EXPECT_EQ(plot.times.size(), 1U);
  EXPECT_EQ(plot.panels[1].curves[1].values.front(), 3.0);
}

TEST(MotionTrace, BeginsAnewAfterARestart) {
  MotionTrace trace;
  trace.take(report(100, 0.0));
  motion_t restarted = report(1, 0.0);
  restarted.session = 2;
  trace.take(restarted);
  EXPECT_EQ(trace.plot("test", std::array{shoulder}, period).times.size(), 1U);
}

TEST(MotionTrace, HasNoPanelWithoutReports) {
  EXPECT_TRUE(MotionTrace{}.plot("test", std::array{shoulder}, period).panels.empty());
}

}  // namespace
}  // namespace takt
