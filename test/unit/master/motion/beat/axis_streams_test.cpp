#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "master/core/kept_state.hpp"
#include "master/motion/planner/stream_check.hpp"
#include "test/unit/master/motion/beat/plant.hpp"

namespace takt::motion {
namespace {

using test::Plant;

MotionOrder stream_order(const Plant& plant, CycleNumber ahead = 1) {
  MotionOrder order = plant.order(0, plant.last[0].commanded, ahead);
  order.profile = {};
  order.ending = Ending::points;
  order.timeout = 1'000'000;
  return order;
}

bool add(Plant& plant, const std::vector<StreamPoint>& points) {
  for (const StreamPoint& point : points) {
    StreamPoints message{.order = plant.ids, .size = 1};
    message.points[0] = point;
    plant.motions.add_points(0, message);
  }
  return true;
}

std::optional<StreamDefect> defect_of(const StreamPoint& from, const StreamPoint& to,
                                      const StreamRules& rules) {
  const auto defect = defect_of_way(from, to, rules);
  return defect ? defect : defect_of_stops(from, to, rules);
}

/// 0.2 sin^3(2 t): smooth, and at rest where it begins.
StreamPoint wave(double time) {
  const double s = std::sin(2 * time);
  const double c = std::cos(2 * time);
  return {.time = time,
          .state = {.position = 0.2 * s * s * s,
                    .velocity = 1.2 * s * s * c,
                    .acceleration = 4.8 * s * c * c - 2.4 * s * s * s}};
}

TEST(AxisStreams, AnAxisFollowsItsPointsAndBetweenThem) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  int next = 1;
  for (int beat = 0; beat < 5000; ++beat) {
    for (; next * 0.02 < beat * 0.001 + 0.4; ++next) add(plant, {wave(next * 0.02)});
    plant.step();
    const State expected = wave(beat * 0.001).state;
    ASSERT_NEAR(plant.last[0].commanded.position, expected.position, 1e-8) << beat;
    ASSERT_NEAR(plant.last[0].commanded.velocity, expected.velocity, 1e-6) << beat;
    ASSERT_EQ(plant.last[0].state, AxisState::moving);
  }
  EXPECT_EQ(plant.ended[0].outcome, Outcome::none);
}

TEST(AxisStreams, PointsThatEndAtRestEndTheMotionAndOthersAStop) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  add(plant, {{.time = 0.5, .state = {.position = 0.05}}});
  plant.step();
  EXPECT_EQ(plant.last[0].cycles_left, 500U);
  plant.steps(499);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.05, 1e-12);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(stream_order(plant)));
  add(plant, {{.time = 0.5, .state = {.position = 0.15, .velocity = 0.4}}});
  plant.steps(501);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_NEAR(plant.last[0].commanded.velocity, 0.4, 1e-12);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::points_ended);
  plant.steps(500);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::stopped);
}

/// The planner refuses each of these; the bus thread must be safe without it.
TEST(AxisStreams, PointsThatDoNotFitAreDropped) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  add(plant, {{.time = 0.5, .state = {.position = 0.05}}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  add(plant, {{.time = 0.5, .state = {.position = 0.05}},
              {.time = 0.4, .state = {.position = 0.05}},
              {.time = nan, .state = {.position = 0.05}},
              {.time = 0.6, .state = {.position = nan}}});
  StreamPoints other{.order = 7, .size = 1};
  other.points[0] = {.time = 0.6, .state = {.position = 1.0}};
  plant.motions.add_points(0, other);
  plant.motions.add_points(9, other);
  plant.steps(502);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.05, 1e-12);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(stream_order(plant)));
  for (int i = 1; i <= 100; ++i)
    add(plant, {{.time = 0.001 * i, .state = plant.last[0].commanded}});
  plant.step();
  EXPECT_EQ(plant.last[0].cycles_left, StreamPlayer::capacity);
}

/// Nobody has checked a curve from the last point before the gap to the next one behind it.
TEST(AxisStreams, APointThatIsLostEndsTheStream) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  for (int i = 1; i <= 65; ++i) add(plant, {wave(i * 0.02)});  // the last one finds no room
  plant.steps(101);
  add(plant, {wave(66 * 0.02)});
  plant.steps(64 * 20 - 100);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_NEAR(plant.last[0].commanded.position, wave(64 * 0.02).state.position, 1e-9);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::points_ended);
  plant.steps(500);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(stream_order(plant)));
  StreamPoint rest{.time = 0.1, .state = plant.last[0].commanded};
  add(plant, {rest});
  plant.step();
  EXPECT_EQ(plant.last[0].cycles_left, 100U) << "the next stream takes points again";
}

/// The curve has an acceleration at its end, which is no part of the point.
TEST(AxisStreams, ACubicCurveThatEndsWithoutVelocityEndsTheMotionAtItsPoint) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  add(plant, {{.time = 2.0, .state = {.position = 0.01}, .curve = Curve::cubic}});
  plant.steps(2001);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.01, 1e-12);
  plant.steps(500);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::none);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.01, 1e-12);
}

/// The next points of a group have come to one axis in time, and to the other axis one cycle too
/// late.
TEST(AxisStreams, AnAxisThatIsDoneWhileItsGroupGoesOnStopsTheGroup) {
  Plant plant{3};
  plant.step();
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    MotionOrder order = stream_order(plant);
    order.axis = axis;
    order.group = axis == 2 ? 2 : 0;
    order.axes = axis == 2 ? 1 : 2;
    ASSERT_TRUE(plant.take(order));
    StreamPoints points{.order = plant.ids, .size = 1};
    points.points[0] = {.time = 0.5, .state = {.position = 0.05}};
    if (axis > 0) points.points[points.size++] = {.time = 1.0, .state = {.position = 0.1}};
    plant.motions.add_points(axis, points);
  }
  plant.steps(501);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_EQ(plant.last[1].state, AxisState::moving);
  plant.step();
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::points_ended);
  EXPECT_EQ(plant.last[1].stop.axis, 0);
  EXPECT_EQ(plant.ended[1].outcome, Outcome::stopped);
  EXPECT_EQ(plant.last[2].state, AxisState::moving) << "it is no axis of this stream";
  plant.steps(500);
  EXPECT_EQ(plant.ended[2].outcome, Outcome::done);
}

/// A checkpoint has the points that wait, not the room for others.
TEST(AxisStreams, TheStateHasTheWaitingPointsOnly) {
  const auto words_of = [](Plant& plant) {
    StateSize size;
    plant.motions.keep(size);
    return size.count();
  };
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(stream_order(plant)));
  const std::size_t without = words_of(plant);
  for (int i = 1; i <= 70; ++i) add(plant, {wave(i * 0.02)});
  plant.steps(501);  // passes 25 of 64
  EXPECT_EQ(plant.motions.points(), 39U);
  ASSERT_EQ(words_of(plant), without + 39 * StreamPoint::kept_words);
  std::vector<std::uint64_t> words(words_of(plant));
  StateWriter writer{words.data()};
  plant.motions.keep(writer);
  Plant other{1};
  StateReader reader{words};
  other.motions.keep(reader);
  other.cycle = plant.cycle;
  other.last = plant.last;
  other.inputs = plant.inputs;
  add(other, {wave(71 * 0.02)});  // a point was lost
  for (int i = 0; i < 1000; ++i) {
    plant.step();
    other.step();
    ASSERT_EQ(other.last[0].commanded.position, plant.last[0].commanded.position) << i;
  }
  EXPECT_EQ(other.last[0].stop.cause, StopCause::points_ended);
}

TEST(AxisStreams, AStreamBeginsOnlyAtRest) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.steps(300);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(stream_order(plant)));
  plant.step();
  EXPECT_EQ(plant.ended[0].id, 2U);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::is_stopping);
  EXPECT_EQ(plant.last[0].running, 1U);
}

/// Whatever the check accepts must keep all limits, also during a stop that may begin in any beat,
/// and must stay inside the range of positions. The plant checks the limits.
TEST(AxisStreams, EachAcceptedStreamKeepsItsLimitsAndItsRangeAlsoInAStop) {
  std::mt19937_64 random{5};
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  const StreamRules rules{
      .limits = Plant::limits, .range = {.min = -0.3, .max = 0.3}, .period = Plant::period};
  int accepted = 0;
  int stopped = 0;
  int near_end = 0;
  for (int run = 0; run < 300; ++run) {
    Plant plant{1};
    plant.step();
    ASSERT_TRUE(plant.take(stream_order(plant)));
    StreamPoint last{.time = 0.0, .state = plant.last[0].commanded};
    for (int tries = 0; tries < 400 && accepted < 20'000; ++tries) {
      const double step = any(0.0005, 0.3);
      const StreamPoint next{
          .time = last.time + step,
          .state = {
              .position = last.state.position + any(-0.3, 0.3) * step + last.state.velocity * step,
              .velocity = last.state.velocity + any(-2.0, 2.0) * step,
              .acceleration = last.state.acceleration + any(-30.0, 30.0) * step}};
      if (defect_of(last, next, rules)) continue;
      if (plant.last[0].state == AxisState::moving && tries % 7 == 0) plant.steps(20);
      if (last.time < (static_cast<double>(plant.cycle) - 2) * Plant::period) break;
      add(plant, {next});
      ++accepted;
      last = next;
    }
    const int beats = static_cast<int>(any(0.0, 1.2 * (last.time / Plant::period + 1)));
    plant.steps(beats);
    if (run % 2 == 0) plant.motions.stop_axis(0, StopCause::application);
    for (int i = 0; i < 6000 && plant.last[0].state != AxisState::standing; ++i) {
      plant.step();
      ASSERT_LE(std::abs(plant.last[0].commanded.position), 0.3 + 1e-6);
      near_end += std::abs(plant.last[0].commanded.position) > 0.29;
    }
    ASSERT_EQ(plant.last[0].state, AxisState::standing);
    stopped += plant.ended[0].outcome == Outcome::stopped;
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(stopped, 100);
  EXPECT_GT(near_end, 0);
}

TEST(StreamCheck, NamesTheFirstDefect) {
  const StreamRules rules{
      .limits = Plant::limits, .range = {.min = -1.0, .max = 1.0}, .period = Plant::period};
  const StreamPoint from{};
  const auto defect = [&](double time, const State& state, Curve curve = Curve::quintic) {
    return defect_of(from, {.time = time, .state = state, .curve = curve}, rules);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(defect(1.0, {.position = 0.1}), std::nullopt);
  EXPECT_EQ(defect(1.0, {.position = 0.1}, Curve::cubic), std::nullopt);
  EXPECT_EQ(defect(0.0, {}), StreamDefect::not_later);
  EXPECT_EQ(defect(-1.0, {}), StreamDefect::not_later);
  EXPECT_EQ(defect(nan, {}), StreamDefect::not_finite);
  EXPECT_EQ(defect(1.0, {.position = nan}), StreamDefect::not_finite);
  EXPECT_EQ(defect(1e-200, {.position = 0.1}), StreamDefect::not_finite);
  EXPECT_EQ(defect(1.0, {.position = 0.6}), StreamDefect::velocity);
  EXPECT_EQ(defect(0.3, {.position = 0.1}), StreamDefect::acceleration);
  EXPECT_EQ(defect(0.05, {.position = 0.001}), StreamDefect::jerk);
  EXPECT_EQ(defect(4.0, {.position = 1.001}), StreamDefect::position);
  EXPECT_EQ(defect(4.0, {.position = 0.99, .velocity = 0.5}), StreamDefect::stop_position);
  EXPECT_EQ(defect(1.0, {.position = 0.3, .velocity = 0.95, .acceleration = 3.0}),
            StreamDefect::stop_velocity);
}

/// A cubic curve begins with another acceleration than the one before has ended with. In the cycle
/// of its first point, a stop begins with the new one.
TEST(StreamCheck, ChecksTheStopFromTheBeginOfEachCurve) {
  const StreamRules rules{
      .limits = Plant::limits, .range = {.min = -10.0, .max = 10.0}, .period = Plant::period};
  const auto defect = [&](double begin) {
    const State from{.velocity = 0.9};
    const State to = advanced({.velocity = 0.9, .acceleration = 4.0}, 0.0005, 0.0);
    return defect_of({.time = begin, .state = from},
                     {.time = begin + 0.0005, .state = to, .curve = Curve::cubic}, rules);
  };
  EXPECT_EQ(defect(1.0), StreamDefect::stop_velocity);
  EXPECT_EQ(defect(1.0002), std::nullopt) << "no cycle is on this curve";
}

}  // namespace
}  // namespace takt::motion
