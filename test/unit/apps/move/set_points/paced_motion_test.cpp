#include "apps/move/set_points/paced_motion.hpp"

#include <algorithm>
#include <deque>
#include <gtest/gtest.h>

namespace takt {
namespace {

constexpr double period = 0.002;
constexpr double lead = 3 * period;

Eigen::VectorXd at(double position) { return Eigen::VectorXd::Constant(1, position); }

/// An axis with a velocity of 1 per second, and a bus that takes a set-point some cycles after the
/// application sent it.
class OnABus : public testing::TestWithParam<int> {
 protected:
  /// Runs one cycle with one image and one set-point. A bus that does not run takes no set-point.
  void cycle(bool bus_runs = true) {
    if (bus_runs) {
      motion.seen(at(shown));
      while (under_way.size() > static_cast<std::size_t>(GetParam())) {
        farthest_jump = std::max(farthest_jump, under_way.front() - shown);
        shown = under_way.front();
        under_way.pop_front();
      }
    }
    const double time = motion.step(period, Hold::no);
    motion.sent(at(time));
    under_way.push_back(time);
  }

  PacedMotion motion{at(0), 0.2, lead};
  std::deque<double> under_way;
  double shown = 0;
  double farthest_jump = 0;
};

TEST_P(OnABus, RunsWithTheClock) {
  for (int i = 0; i < 500; ++i) cycle();
  EXPECT_NEAR(motion.time(), 1.0, 1e-9);
  EXPECT_EQ(motion.refused(), 0.0);
}

TEST_P(OnABus, StandsWhileTheBusDoesAndJumpsNoFartherThanItsLead) {
  for (int i = 0; i < 100; ++i) cycle();
  const double before = motion.time();
  for (int i = 0; i < 100; ++i) cycle(false);
  EXPECT_LE(motion.time(), before + lead + 1e-9);
  EXPECT_TRUE(motion.standing());
  EXPECT_GT(motion.refused(), 0.15);

  under_way = {under_way.back()};  // only the newest set-point counts
  for (int i = 0; i < 400; ++i) cycle();
  EXPECT_LE(farthest_jump, lead + 1e-9);
  EXPECT_EQ(motion.refused(), 0.0);
  EXPECT_NEAR(motion.time(), before + 0.8, 0.11) << "0.1 s were lost by the ramp";
}

INSTANTIATE_TEST_SUITE_P(Latency, OnABus, testing::Values(0, 1));

TEST(PacedMotion, IsNotRefusedWhileItIsHeld) {
  PacedMotion motion{at(0), 0.2, lead};
  for (int i = 0; i < 500; ++i) motion.step(period, Hold::yes);
  EXPECT_TRUE(motion.standing());
  EXPECT_EQ(motion.refused(), 0.0);
}

}  // namespace
}  // namespace takt
