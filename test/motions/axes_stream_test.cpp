// Streams by the library of applications, with a whole master, its gateway and simulated drives in
// virtual time.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include <takt/motion.hpp>

#include "test/motions/link_in_virtual_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::LinkInVirtualTime;
using test::MotionBus;
using testing::HasSubstr;
using Kind = Obstacle::Kind;

constexpr double period = 0.002;  // of the cycle of the demo

/// A path of both axes that is at rest where it begins, and at multiples of pi: A sin^3(t).
PathPoint wave(double time) {
  const double s = std::sin(time);
  const double c = std::cos(time);
  const Eigen::Vector2d sizes{1.0, -0.5};
  return {.time = time,
          .position = sizes * (s * s * s),
          .velocity = sizes * (3 * s * s * c),
          .acceleration = sizes * (6 * s * c * c - 3 * s * s * s)};
}

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

class AxesStream : public ::testing::Test {
 protected:
  AxesStream() {
    auto link = std::make_unique<LinkInVirtualTime>(bus_);
    link->loses = [this](const std::string& channel) {
      if (channel != "DEMO_MOTION_STREAM") return false;
      ++messages_;
      return loses_ && loses_(messages_);
    };
    auto opened = Axes::open(std::move(link), {.bus = "demo", .longest = 100s, .timeout = 10s});
    EXPECT_TRUE(opened) << opened.error().text;
    axes_.emplace(std::move(*opened));
    const Done enabled = axes_->enable();
    EXPECT_TRUE(enabled) << enabled.error().text;
    // A sign of life for 10 s of the bus, which pass in less time than 50 ms of the program.
    EXPECT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
  }
  static MotionBounds bounds() {
    return {.velocity = Eigen::VectorXd::Constant(1, 3.0),
            .acceleration = Eigen::VectorXd::Constant(1, 20.0),
            .jerk = Eigen::VectorXd::Constant(1, 400.0)};
  }
  /// Gives the points of the wave up to this time.
  Done give(double until, double step, std::size_t batch) {
    std::vector<PathPoint> points;
    while (time_ < until) {
      points.clear();
      for (std::size_t i = 0; i < batch && time_ < until; ++i) {
        time_ = std::min(time_ + step, until);
        points.push_back(wave(time_));
      }
      if (Done given = axes_->stream(points); !given) return given;
    }
    return {};
  }
  void watch_the_path() {
    bus_.each_cycle = [this] {
      if (bus_.axis(0).state != test::moving) return;
      if (first_cycle_ == 0) first_cycle_ = bus_.lcm.motion.cycle;
      const double time = static_cast<double>(bus_.lcm.motion.cycle - first_cycle_) * period;
      const double s = std::sin(time);
      ASSERT_NEAR(bus_.axis(0).position, s * s * s, 1e-6) << time;
      ASSERT_NEAR(bus_.axis(1).position, -0.5 * s * s * s, 1e-6) << time;
      ++compared_;
    };
  }
  /// The axes are at rest at the end of the wave, and taktd has refused and stopped nothing.
  void expect_end() {
    EXPECT_FALSE(bus_.said("motion_refused", ""));
    EXPECT_FALSE(bus_.said("motion_stopped", ""));
    EXPECT_GT(compared_, 1500) << "pi / 2 ms";
    EXPECT_FALSE(axes_->moving());
    EXPECT_NEAR(axes_->commanded_positions()(0), 0.0, 1e-9);
  }

  MotionBus bus_;
  std::optional<Axes> axes_;
  double time_ = 0.0;
  std::int64_t first_cycle_ = 0;
  int compared_ = 0;
  int messages_ = 0;
  std::function<bool(int)> loses_;
};

TEST_F(AxesStream, FollowTheirPathToItsEnd) {
  watch_the_path();
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  const Done given = give(1.5, 0.02, 5);
  ASSERT_TRUE(given) << given.error().text;
  EXPECT_NEAR(axes_->stream_left(), 0.4, 0.12) << "the program is this much ahead";
  ASSERT_TRUE(give(std::numbers::pi, 0.02, 5));
  const Done ended = axes_->wait();
  ASSERT_TRUE(ended) << ended.error().text;
  expect_end();
  EXPECT_EQ(axes_->stream_left(), 0.0);
  EXPECT_LT(messages_, 3.2 / 0.02 + 10) << "not more than one in 20 ms";
}

TEST_F(AxesStream, FollowPointsThatComeOneByOne) {
  watch_the_path();
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  const Done given = give(std::numbers::pi, 0.003, 1);
  ASSERT_TRUE(given) << given.error().text;
  const Done ended = axes_->wait();
  ASSERT_TRUE(ended) << ended.error().text;
  expect_end();
}

TEST_F(AxesStream, OutliveMessagesThatAreLost) {
  watch_the_path();
  loses_ = [](int number) { return number % 3 == 1; };
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  ASSERT_TRUE(give(std::numbers::pi, 0.02, 5));
  const Done ended = axes_->wait();
  ASSERT_TRUE(ended) << ended.error().text;
  expect_end();
}

TEST_F(AxesStream, BeginWithFewPointsWhenTheyAreWaitedFor) {
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  const PathPoint target{.time = 0.3,
                         .position = Eigen::Vector2d{0.01, 0.02},
                         .velocity = Eigen::Vector2d{0.0, 0.0},
                         .acceleration = Eigen::Vector2d{0.0, 0.0}};
  ASSERT_TRUE(axes_->stream(std::span{&target, 1}));
  ASSERT_TRUE(axes_->run(1ms));
  EXPECT_EQ(messages_, 0) << "few points, and more may come";
  const Done ended = axes_->wait();
  ASSERT_TRUE(ended) << ended.error().text;
  EXPECT_EQ(axes_->commanded_positions(), Eigen::Vector2d(0.01, 0.02));
}

TEST_F(AxesStream, SayThatTheirPointsHaveEnded) {
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  ASSERT_TRUE(give(0.6, 0.02, 5));
  bus_.run(500);  // the program computes for 1 s
  const Obstacle why = obstacle_of(give(2.0, 0.02, 5));
  EXPECT_EQ(why.kind, Kind::stopped);
  EXPECT_THAT(why.text, HasSubstr("the points of its stream have ended while it moved"));
  EXPECT_FALSE(axes_->moving());
  const int before = messages_;
  EXPECT_EQ(obstacle_of(give(2.0, 0.02, 5)).kind, Kind::wrong_use);
  ASSERT_TRUE(axes_->run(1ms));
  EXPECT_EQ(messages_, before) << "nothing is sent after the obstacle";
}

TEST_F(AxesStream, SayWhichPointIsRefusedAndStop) {
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  ASSERT_TRUE(give(0.6, 0.02, 5));
  PathPoint far = wave(0.62);
  far.position(1) += 1.0;
  const Done given = axes_->stream(std::span{&far, 1});
  const Obstacle why = obstacle_of(given ? axes_->wait() : given);
  EXPECT_EQ(why.kind, Kind::refused);
  EXPECT_THAT(why.text, HasSubstr("its point 31: "));
  EXPECT_THAT(why.text, HasSubstr("limit"));
  EXPECT_TRUE(axes_->stop());
  EXPECT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
}

TEST_F(AxesStream, SayWhatIsWrongWithTheirUse) {
  const PathPoint point = wave(0.1);
  EXPECT_THAT(obstacle_of(axes_->stream(std::span{&point, 1})).text, HasSubstr("begin_stream()"));
  const auto wrong = [&](const PathPoint& bad) {
    EXPECT_TRUE(axes_->begin_stream(bounds()));
    const Obstacle why = obstacle_of(axes_->stream(std::span{&bad, 1}));
    EXPECT_EQ(why.kind, Kind::wrong_use);
    return why.text;
  };
  PathPoint bad = wave(0.1);
  bad.velocity.resize(0);
  EXPECT_THAT(wrong(bad), HasSubstr("one velocity for each of 2 axes"));
  for (const double time : {-0.1, 4.1, std::nan("")}) {
    bad = wave(0.1);
    bad.time = time;
    EXPECT_THAT(wrong(bad), HasSubstr("it must be later than the point before, which is at 0 s"));
  }
  EXPECT_EQ(messages_, 0);
}

TEST_F(AxesStream, BeginAtRestOnlyAndEndBeforeAnotherMotion) {
  ASSERT_TRUE(axes_->begin_move(Eigen::Vector2d{1.0, 1.0}, bounds()));
  bus_.run(20);
  ASSERT_TRUE(axes_->run(1ms));
  EXPECT_THAT(obstacle_of(axes_->begin_stream()).text, HasSubstr("a stream begins at rest"));
  ASSERT_TRUE(axes_->wait());
  ASSERT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  ASSERT_TRUE(give(0.6, 0.02, 5));
  EXPECT_THAT(obstacle_of(axes_->move(Eigen::Vector2d{1.0, 1.0})).text,
              HasSubstr("the axes follow a stream: call wait() or stop()"));
  ASSERT_TRUE(axes_->stop());
  EXPECT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
}

TEST_F(AxesStream, RefuseAFirstPointThatIsNotWhereTheyStand) {
  ASSERT_TRUE(axes_->begin_stream(bounds()));
  PathPoint start = wave(0.0);
  start.position(0) = 0.1;
  ASSERT_TRUE(axes_->stream(std::span{&start, 1}));
  const Obstacle why = obstacle_of(give(0.6, 0.02, 5));
  EXPECT_EQ(why.kind, Kind::refused);
  EXPECT_THAT(why.text, HasSubstr("is not at the position of the axis"));
}

}  // namespace
}  // namespace takt
