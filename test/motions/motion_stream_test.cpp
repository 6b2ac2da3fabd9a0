// Streams of points over LCM, from the bytes of motion_stream_t to the simulated drives.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionBus;

constexpr double period = 0.002;  // of the cycle of the demo

/// A path that is at rest where it begins: A sin^3(t).
motion_point_t wave(double time, std::vector<double> sizes) {
  const double s = std::sin(time);
  const double c = std::cos(time);
  motion_point_t point{};
  point.time = time;
  for (const double size : sizes) {
    point.position.push_back(size * s * s * s);
    point.velocity.push_back(size * 3 * s * s * c);
    point.acceleration.push_back(size * (6 * s * c * c - 3 * s * s * s));
  }
  return point;
}

/// An application that keeps its points this far ahead.
class StreamingApplication {
 public:
  static constexpr double ahead = 0.4;
  static constexpr double step = 0.02;

  StreamingApplication(MotionBus& bus, std::vector<std::string> nodes, std::vector<double> sizes)
      : bus_{bus}, nodes_{std::move(nodes)}, sizes_{std::move(sizes)} {}

  void send() {
    if (!began_) began_ = bus_.world.now();
    const double now = std::chrono::duration<double>{bus_.world.now() - *began_}.count();
    std::vector<motion_point_t> points;
    const std::int64_t first = next_;
    for (; static_cast<double>(next_) * step <= now + ahead; ++next_) {
      points.push_back(wave(static_cast<double>(next_) * step, sizes_));
    }
    send(first, points);
  }
  void send(std::int64_t first, const std::vector<motion_point_t>& points) {
    bus_.send_stream(id, nodes_, first, points);
  }

  std::int32_t id = 1;

 private:
  MotionBus& bus_;
  std::vector<std::string> nodes_;
  std::vector<double> sizes_;
  std::optional<Time> began_;
  std::int64_t next_ = 0;
};

/// An application at 50 Hz whose messages come up to 10 ms late, and which stalls for 300 ms now
/// and then. The drive gets each set-point of the path, one in each cycle.
TEST(MotionStream, JitterAndStallsOfTheApplicationDoNotReachTheDrive) {
  MotionBus bus;
  bus.enable();
  StreamingApplication application{bus, {"shoulder"}, {1.0}};
  std::mt19937_64 random{4};
  Time next = bus.world.now();
  std::int64_t first_cycle = 0;
  std::int64_t commanded = bus.target(0);
  int compared = 0;
  double shortest = 1.0;
  bus.each_cycle = [&] {
    if (bus.axis(0).id == 1) {
      if (first_cycle == 0) first_cycle = bus.lcm.motion.cycle;
      const double time = static_cast<double>(bus.lcm.motion.cycle - first_cycle) * period;
      const double s = std::sin(time);
      ASSERT_NEAR(bus.axis(0).position, s * s * s, 1e-6) << time;
      if (compared > 0) {
        ASSERT_EQ(bus.target(0), commanded) << time;
      }
      commanded = std::lround(bus.axis(0).position / MotionBus::scale);
      shortest = std::min(shortest, bus.axis(0).time_left);
      ++compared;
    }
    if (bus.world.now() < next) return;
    const Time jitter{static_cast<std::int64_t>(random() % 10'000'000)};
    next = bus.world.now() + (random() % 40 == 0 ? 300ms : 20ms) + jitter;
    application.send();
  };
  bus.run(50'000);
  EXPECT_GT(compared, 49'000) << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
  EXPECT_LT(shortest, 0.15) << "it did stall";
  EXPECT_FALSE(bus.said("motion_refused", ""));
  EXPECT_FALSE(bus.said("motion_stopped", ""));
}

TEST(MotionStream, AnApplicationThatDiesLeavesItsPointsAndThenAStopAlongTheLimits) {
  MotionBus bus;
  bus.enable();
  StreamingApplication application{bus, {"shoulder", "elbow"}, {1.0, -0.5}};
  bus.each_cycle = [&, count = 0]() mutable {
    if (count++ % 10 == 0) application.send();
  };
  bus.run(410);  // 0.82 s: both axes are fast
  bus.each_cycle = {};
  const double left = bus.axis(0).time_left;
  EXPECT_NEAR(left, 0.4, 0.03);
  const auto cycles = static_cast<int>(left / period);
  bus.run(cycles - 2);
  EXPECT_EQ(bus.axis(0).state, test::moving);
  bus.run(4);
  EXPECT_EQ(bus.axis(0).state, test::stopping);
  EXPECT_EQ(bus.axis(1).state, test::stopping);
  EXPECT_TRUE(bus.said("motion_stopped", "the points of its stream have ended"));
  double before = bus.axis(0).velocity;
  while (bus.axis(0).state == test::stopping) {
    bus.cycle();
    ASSERT_LE(std::abs(bus.axis(0).velocity - before), 20.0 * period + 1e-9);
    before = bus.axis(0).velocity;
  }
  EXPECT_EQ(bus.axis(0).state, test::standing);
  EXPECT_EQ(bus.axis(0).outcome, test::stopped);
}

TEST(MotionStream, AllAxesBeginInTheSameCycleAndEndAtRest) {
  MotionBus bus;
  bus.enable();
  motion_point_t end{};
  end.time = 1.0;
  end.position = {0.5, -0.25};
  end.velocity = {0.0, 0.0};
  end.acceleration = {0.0, 0.0};
  bus.send_stream(4, {"shoulder", "elbow"}, 0, {wave(0.0, {1.0, 1.0}), end});
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).id == 4; }, 20));
  EXPECT_EQ(bus.axis(1).id, 4);
  EXPECT_NEAR(bus.axis(0).time_left, 1.0, 1e-9);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 4; }, 510));
  EXPECT_EQ(bus.axis(0).outcome, test::done);
  EXPECT_EQ(bus.axis(1).outcome, test::done);
  bus.run(10);
  EXPECT_NEAR(bus.position(1), -0.25, 1e-3);
}

TEST(MotionStream, PointsThatHaveComeBeforeAreSkippedAndMissingOnesAreNamed) {
  MotionBus bus;
  bus.enable();
  std::vector<motion_point_t> points;
  for (int i = 0; i < 40; ++i) points.push_back(wave(i * 0.02, {1.0}));
  const auto part = [&](int first, int count) {
    bus.send_stream(1, {"shoulder"}, first,
                    {points.begin() + first, points.begin() + first + count});
    bus.run(2);
  };
  part(0, 10);
  part(0, 15);
  part(20, 5);
  EXPECT_TRUE(bus.said("motion_refused", "its point 15 is missing"));
  part(10, 20);
  bus.run(5);
  ASSERT_EQ(bus.axis(0).id, 1);
  const double time = 29 * 0.02 - bus.axis(0).time_left;
  EXPECT_GT(time, 0.0);
  EXPECT_NEAR(bus.axis(0).position, std::pow(std::sin(time), 3), 1e-6);
}

TEST(MotionStream, RefusesAStreamThatDoesNotBeginWhereTheAxisStands) {
  MotionBus bus;
  bus.enable();
  std::int32_t id = 6;
  const auto begin = [&](motion_point_t first, const std::string& words) {
    bus.notices.clear();
    bus.send_stream(++id, {"shoulder"}, 0, {std::move(first), wave(0.1, {1.0})});
    bus.run(10);
    EXPECT_TRUE(bus.said("motion_refused", words))
        << words << ": " << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
    EXPECT_EQ(bus.axis(0).state, test::standing) << words;
    EXPECT_EQ(bus.axis(0).ended_id, id);
    EXPECT_EQ(bus.axis(0).outcome, test::refused);
  };
  motion_point_t first = wave(0.0, {1.0});
  first.position[0] = 0.001;
  begin(first, "is not at the position of the axis");
  first = wave(0.0, {1.0});
  first.velocity[0] = 0.1;
  begin(first, "is not at the position of the axis");
  first = wave(0.0, {1.0, 1.0});
  begin(first, "needs one position");
  first = wave(0.0, {1.0});
  first.position[0] = std::numeric_limits<double>::quiet_NaN();
  begin(first, "infinite, NaN");
  bus.notices.clear();
  bus.send_stream(++id, {"shoulder"}, 5, {wave(0.1, {1.0})});
  bus.run(3);
  EXPECT_TRUE(bus.said("motion_refused", "begins with point 0"));
}

/// A point that is refused does not end the stream: the axis follows the points before it.
TEST(MotionStream, RefusesAPointWithTheReasonAndFollowsThoseBefore) {
  MotionBus bus;
  bus.enable();
  std::int32_t id = 10;
  const auto refusal = [&](auto change, const std::string& words) {
    bus.run(600);
    ASSERT_EQ(bus.axis(0).state, test::standing) << words;
    bus.notices.clear();
    const double stands = bus.axis(0).position;
    const auto at = [&](double time, double way) {
      motion_point_t point = wave(0.0, {1.0});
      point.time = time;
      point.position[0] = stands + way;
      return point;
    };
    std::vector<motion_point_t> points{at(0.0, 0.0), at(0.5, 0.1), at(1.0, 0.2)};
    change(points.back());
    bus.send_stream(++id, {"shoulder"}, 0, points);
    bus.run(100);
    bus.keep_alive();
    EXPECT_TRUE(bus.said("motion_refused", "its point 2: " + words))
        << words << ": " << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
    bus.run(200);
    EXPECT_EQ(bus.axis(0).ended_id, id) << words;
    EXPECT_EQ(bus.axis(0).outcome, test::done) << words;
    EXPECT_NEAR(bus.axis(0).position, stands + 0.1, 1e-9) << words;
  };
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.send_stream(9, {"shoulder"}, 0, {wave(0.0, {1.0}), wave(0.1, {0.0})});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Point = motion_point_t;
  refusal([&](Point& p) { p.position[0] = nan; }, "a number is infinite");
  refusal([](Point& p) { p.time = 0.5; }, "its time is not later");
  refusal([](Point& p) { p.time = 0.3; }, "its time is not later");
  refusal([&](Point& p) { p.time = nan; }, "a number is infinite");
  refusal([](Point& p) { p.time = 7.0; }, "it is more than 5 s in the future");
  refusal([](Point& p) { p.position[0] += 2.0; }, "the velocity would exceed");
  refusal([](Point& p) { p.velocity[0] = 2.9; }, "the acceleration would exceed");
  refusal([](Point& p) { p.time = 0.52, p.position[0] -= 0.0999; }, "the jerk would exceed");
  refusal([](Point& p) { p.position.push_back(0.0); }, "it needs one position");
  refusal([](Point& p) { p.acceleration = {1.0, 2.0}; }, "it needs one position");
}

TEST(MotionStream, AMoveDuringAStreamIsRefusedAndAStopEndsIt) {
  MotionBus bus;
  bus.enable();
  StreamingApplication application{bus, {"shoulder"}, {1.0}};
  bus.each_cycle = [&, count = 0]() mutable {
    if (count++ % 10 == 0) application.send();
  };
  bus.run(300);
  bus.move_one(5, 1.0);
  bus.run(5);
  EXPECT_TRUE(bus.said("motion_refused", "follows a stream: stop it first"));
  EXPECT_EQ(bus.axis(0).id, 1);
  motion_command_t stop = bus.command("stop", 0);
  stop.goals = {MotionBus::goal("shoulder", 0.0)};
  bus.send(stop);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == test::stopping; }, 5));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == test::standing; }, 500));
  bus.run(50);
  EXPECT_TRUE(bus.said("motion_refused", "its stream does not run"));
  EXPECT_EQ(bus.axis(0).state, test::standing);
}

/// An application may send all points again as a sign of life, also after the end.
TEST(MotionStream, AClosedPathIsNotRunAgainByItsOwnPoints) {
  MotionBus bus;
  bus.enable();
  std::vector<motion_point_t> points{wave(0.0, {1.0}), wave(0.0, {1.0}), wave(0.0, {1.0})};
  points[1].time = 0.5;
  points[1].position = {0.1};
  points[2].time = 1.0;
  bus.each_cycle = [&, count = 0]() mutable {
    if (count++ % 25 == 0) bus.send_stream(1, {"shoulder"}, 0, points);
  };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 1; }, 600));
  EXPECT_FALSE(bus.said("motion_refused", ""));
  bus.run(100);
  EXPECT_EQ(bus.axis(0).state, 1);
  EXPECT_EQ(bus.axis(0).outcome, 1);
  EXPECT_TRUE(bus.said("motion_refused", "the stream with its id is over"));
  bus.each_cycle = {};
  bus.send_stream(2, {"shoulder"}, 0, points);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).id == 2; }, 10));
}

TEST(MotionStream, CubicCurvesThatEndWithoutVelocityAreDoneAtTheirLastPoint) {
  MotionBus bus;
  bus.enable();
  motion_point_t end = wave(0.0, {1.0});
  end.time = 1.0;
  end.position = {0.5};
  end.acceleration.clear();
  bus.send_stream(1, {"shoulder"}, 0, {wave(0.0, {1.0}), end});
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 1; }, 600));
  EXPECT_EQ(bus.axis(0).outcome, 1);
  bus.run(50);
  EXPECT_NEAR(bus.axis(0).position, 0.5, 1e-12);
}

/// If a motion is refused, earlier points that arrive after it are still accepted.
TEST(MotionStream, PointsArriveBehindARefusedMoveOfTheSameImage) {
  MotionBus bus;
  bus.enable();
  bus.send_stream(1, {"shoulder"}, 0, {wave(0.0, {1.0}), wave(0.02, {1.0})});
  bus.run(2);
  motion_command_t move = bus.command("move", 5);
  move.utime = 2000;
  move.goals = {MotionBus::goal("shoulder", 1.0)};
  bus.send(move);
  bus.send_stream(1, {"shoulder"}, 2, {wave(0.04, {1.0}), wave(0.06, {1.0})});  // utime 0
  bus.run(2);
  EXPECT_FALSE(bus.said("motion_refused", "has already come"));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).id == 1; }, 5));
  EXPECT_GT(bus.axis(0).time_left, 0.05);
}

TEST(MotionStream, MorePointsThanTheBufferHoldsAreRefused) {
  MotionBus bus;
  bus.enable();
  std::vector<motion_point_t> points;
  for (int i = 0; i < 80; ++i) points.push_back(wave(i * 0.02, {1.0}));
  bus.send_stream(1, {"shoulder"}, 0, points);
  bus.run(10);
  EXPECT_TRUE(bus.said("motion_refused", "its point 65: 64 points wait already"));
  ASSERT_EQ(bus.axis(0).id, 1);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).time_left < 0.1; }, 1000));
  EXPECT_NEAR(bus.axis(0).position, std::pow(std::sin(64 * 0.02 - bus.axis(0).time_left), 3), 1e-6);
}

}  // namespace
}  // namespace takt
