// Programs that run at 50 Hz, are late, and stall, and the set-points that their drives receive.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "master/motion/trajectory.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using test::MotionBus;

constexpr double period = 0.002;  // s, of the cycle of the demo
constexpr motion::Limits limits{.max_velocity = 3.0,
                                .min_velocity = -3.0,
                                .max_acceleration = 20.0,
                                .min_acceleration = -20.0,
                                .jerk = 400.0};

/// With TAKT_CYCLES=1000000, the long tests are as long as the requirement demands.
int cycles_of_test() {
  const char* const wanted = std::getenv("TAKT_CYCLES");
  return wanted == nullptr ? 50'000 : std::atoi(wanted);
}

/// The cycles in which a program runs: each 20 ms, up to 10 ms early or late. After one of fifty,
/// it stalls for 300 ms.
class LateProgram {
 public:
  bool runs() {
    if (--wait_ > 0) return false;
    wait_ = std::uniform_int_distribution<int>{5, 15}(random_);
    if (std::uniform_int_distribution<int>{1, 50}(random_) == 1) {
      wait_ += 150;
      ++stalls_;
    }
    return true;
  }
  int stalls() const noexcept { return stalls_; }

 private:
  std::mt19937 random_{1};
  int wait_ = 0;
  int stalls_ = 0;
};

/// Compares the target positions that a drive receives with those of an ideal source.
class SetPoints {
 public:
  /// Begins a motion from standstill. Its first cycle is known when the first count changes.
  void expect(const motion::State& from, const motion::Profile& profile) {
    from_ = from;
    profile_ = profile;
    cycle_ = 0;
    while (counts_at(cycle_) == counts_at(0)) ++cycle_;
    started_ = false;
  }
  void receive(std::int64_t target) {
    if (!started_ && target == counts_at(0)) return;
    started_ = true;
    const double exact = position_at(cycle_++) / MotionBus::scale;
    // A position halfway between two counts may be rounded up or down.
    if (std::abs(static_cast<double>(target) - exact) > 0.5 + 1e-6) ++wrong_;
    ++compared_;
  }
  int wrong() const noexcept { return wrong_; }
  int compared() const noexcept { return compared_; }

 private:
  double position_at(int cycle) const { return profile_.at(from_, cycle * period).position; }
  std::int64_t counts_at(int cycle) const {
    return std::llround(position_at(cycle) / MotionBus::scale);
  }

  motion::State from_;
  motion::Profile profile_;
  int cycle_ = 0;
  bool started_ = false;
  int wrong_ = 0;
  int compared_ = 0;
};

motion::Profile plan(const motion::State& from, double to, const motion::Limits& within = limits) {
  const std::vector<motion::AxisTask> tasks{
      {.from = from, .to = {.position = to}, .limits = within}};
  std::vector<motion::PlannedAxis> planned(1);
  EXPECT_TRUE(motion::plan_trajectory(tasks, {}, planned).has_value());
  return planned[0].profile;
}

TEST(BusyProgram, ItsMovesHaveNoDuplicatedAndNoSkippedSetPoint) {
  MotionBus bus;
  bus.enable();
  LateProgram program;
  SetPoints set_points;
  std::mt19937 random{2};
  std::int32_t id = 1;
  double at = 0.0;
  const auto begin_move = [&] {
    const double to = std::uniform_real_distribution{-3.0, 3.0}(random);
    const motion::State from{.position = at};
    set_points.expect(from, plan(from, to));
    at = to;
    bus.move_one(id, to);
  };
  begin_move();
  for (int i = 0; i < cycles_of_test(); ++i) {
    bus.cycle();
    set_points.receive(bus.target(0));
    if (!program.runs()) continue;
    bus.keep_alive();
    if (bus.axis(0).ended_id != id) continue;
    ASSERT_EQ(bus.axis(0).outcome, test::done);
    ++id;
    begin_move();
  }
  EXPECT_EQ(set_points.wrong(), 0);
  EXPECT_GT(set_points.compared(), cycles_of_test() * 9 / 10);
  EXPECT_GT(program.stalls(), cycles_of_test() / 1000);
}

motion_point_t point_of(const motion::State& state, double time) {
  motion_point_t point{};
  point.time = time;
  point.position = {state.position};
  point.velocity = {state.velocity};
  point.acceleration = {state.acceleration};
  return point;
}

/// A path that is at rest only at multiples of pi: sin^3(t).
motion_point_t wave(double time) {
  const double s = std::sin(time);
  const double c = std::cos(time);
  return point_of({.position = s * s * s,
                   .velocity = 3 * s * s * c,
                   .acceleration = 6 * s * c * c - 3 * s * s * s},
                  time);
}

TEST(BusyProgram, ItsStreamHasNoDuplicatedAndNoSkippedSetPoint) {
  MotionBus bus;
  bus.enable();
  LateProgram program;
  constexpr double step = 0.02;
  std::int64_t next = 0;
  const auto fill = [&](double passed) {
    std::vector<motion_point_t> points;
    const std::int64_t first = next;
    while (static_cast<double>(next) * step < passed + 0.4) {
      points.push_back(wave(static_cast<double>(next++) * step));
    }
    if (!points.empty()) bus.send_stream(1, {"shoulder"}, first, points);
  };
  fill(0.0);
  std::int64_t begin = 0;  // cycle of the first set-point
  std::int64_t before = 0;
  int compared = 0;
  for (int i = 0; i < cycles_of_test(); ++i) {
    bus.cycle();
    if (begin == 0 && bus.axis(0).state == test::moving) begin = bus.lcm.motion.cycle;
    const double passed =
        begin == 0 ? 0.0 : static_cast<double>(bus.lcm.motion.cycle - begin) * period;
    const std::int64_t target = bus.target(0);
    if (passed > 0.1) {
      // The drive has received the set-point of the cycle before.
      const double s = std::sin(passed - period);
      ASSERT_NEAR(static_cast<double>(target) * MotionBus::scale, s * s * s, MotionBus::scale)
          << "after " << passed << " s; before it was " << before;
      ++compared;
    }
    before = target;
    if (program.runs()) fill(passed);
  }
  EXPECT_GT(compared, cycles_of_test() * 9 / 10);
  EXPECT_GT(program.stalls(), cycles_of_test() / 1000);
}

/// Returns the standard deviation of the velocity of a drive, divided by its mean, in the middle of
/// a long motion.
double ripple(const std::vector<double>& positions) {
  std::vector<double> steps;
  const std::size_t begin = positions.size() / 2 - 300;
  for (std::size_t i = begin; i < begin + 600; ++i) {
    steps.push_back(positions[i + 1] - positions[i]);
  }
  const double mean = std::accumulate(steps.begin(), steps.end(), 0.0) / 600;
  double squares = 0.0;
  for (const double step : steps) squares += (step - mean) * (step - mean);
  return std::sqrt(squares / 600) / mean;
}

/// Runs a motion from 0 to 6 rad and returns the positions of the drive in its cycles. `work` runs
/// in each cycle, and gets their number.
template <class Work>
double ripple_of(MotionBus& bus, Work work) {
  std::vector<double> positions;
  for (int i = 0; i < 1250; ++i) {
    work(i);
    bus.cycle();
    positions.push_back(bus.position(0));
  }
  EXPECT_NEAR(positions.back(), 6.0, 0.01);
  const auto first = std::ranges::find_if(positions, [](double at) { return at > 0.01; });
  const auto last = std::ranges::find_if(positions, [](double at) { return at > 5.99; });
  return ripple({first, last});
}

/// Ripple with a program that sends a set-point in each n-th cycle.
double ripple_of_set_points(int every) {
  MotionBus bus;
  bus.enable();
  const motion::Profile profile = plan({}, 6.0);
  return ripple_of(bus, [&](int cycle) {
    if (cycle % every != 0) return;
    const double position = profile.at({}, cycle * period).position;
    bus.send_outputs(
        0, {{0x6040, 0x0F}, {0x6060, 8}, {0x607A, std::llround(position / MotionBus::scale)}});
  });
}

TEST(BusyProgram, ItsDriveRunsAsSmoothlyAsWithAnIdealSource) {
  const double ideal = ripple_of_set_points(1);

  MotionBus moved;
  moved.enable();
  moved.move_one(1, 6.0);
  LateProgram mover;
  const double by_move = ripple_of(moved, [&](int) {
    if (mover.runs()) moved.keep_alive();
  });
  EXPECT_LE(by_move, 1.01 * ideal);

  MotionBus streamed;
  streamed.enable();
  // The polynomials between the points overshoot the velocities and accelerations a little.
  motion::Limits softer = limits;
  softer.max_velocity = 2.9;
  softer.max_acceleration = 10.0;
  softer.min_acceleration = -10.0;
  softer.jerk = 200.0;
  const motion::Profile profile = plan({}, 6.0, softer);
  LateProgram streamer;
  std::vector<motion_point_t> points;
  for (double time = 0.0; time < profile.duration(); time += 0.02) {
    points.push_back(point_of(profile.at({}, time), time));
  }
  points.push_back(point_of(profile.end({}), profile.duration()));
  std::size_t sent = 0;
  const double by_stream = ripple_of(streamed, [&](int cycle) {
    if (!streamer.runs()) return;
    const std::size_t first = sent;
    while (sent < points.size() && points[sent].time < cycle * period + 0.4) ++sent;
    const auto begin = points.begin();
    if (sent > first) {
      streamed.send_stream(
          1, {"shoulder"}, static_cast<std::int64_t>(first),
          {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(sent)});
    }
  });
  for (const Notice& notice : streamed.notices) {
    EXPECT_NE(notice.kind, "motion_refused") << notice.text;
  }
  EXPECT_LE(by_stream, 1.01 * ideal);

  const double at_50_hertz = ripple_of_set_points(10);
  EXPECT_GT(at_50_hertz, 10 * ideal);
  std::printf("ripple of the drive: ideal %.4f, by move %.4f, by stream %.4f, at 50 Hz %.4f\n",
              ideal, by_move, by_stream, at_50_hertz);
}

}  // namespace
}  // namespace takt
