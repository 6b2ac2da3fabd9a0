// What MotionStreams checks and sends, without a bus.
#include <gtest/gtest.h>
#include <optional>
#include <utility>
#include <vector>

#include "master/gateway/motion/motion_streams.hpp"

namespace takt {
namespace {

/// Two axes at standstill, with a cycle of 0.2 ms.
struct StreamsAlone {
  static constexpr double period = 0.0002;
  static constexpr std::uint64_t begin = 100;

  StreamsAlone() {
    MotionJob job{.name = {.id = 1}, .instance = 5, .order = 9, .begin = begin};
    for (std::uint8_t axis = 0; axis < 2; ++axis) {
      job.goals.push_back({.axis = axis,
                           .to = {},
                           .limits = {.max_velocity = 3.0,
                                      .min_velocity = -3.0,
                                      .max_acceleration = 20.0,
                                      .min_acceleration = -20.0,
                                      .jerk = 400.0},
                           .range = {.min = -1.0, .max = 1.0}});
      motion::MotionOrder order{};
      order.axis = axis;
      order.id = 9;
      job.orders.push_back(order);
    }
    streams.begin(job, 0.0);
  }
  static motion_point_t point(double time, std::vector<double> positions = {0.0, 0.0},
                              std::vector<double> velocities = {0.0, 0.0}) {
    motion_point_t made{};
    made.time = time;
    made.position = std::move(positions);
    made.velocity = std::move(velocities);
    made.acceleration = {0.0, 0.0};
    return made;
  }
  std::optional<MotionRefusal> add(std::int64_t first, std::vector<motion_point_t> points,
                                   std::uint64_t cycle, std::uint64_t reported) {
    motion_stream_t message{};
    message.instance = 5;
    message.id = 1;
    message.first_point = first;
    message.points = std::move(points);
    return streams.add(message, cycle, reported);
  }

  std::size_t sent = 0;  ///< points of the first axis
  MotionStreams streams{period, [this](const motion::MotionMessage& message) {
                          if (message.axis == 0) sent += message.points.size;
                          return true;
                        }};
};

/// In a cycle, messages are handled before the bus thread has passed the points of this cycle. So
/// its ring has room only for as many points as it has reported.
TEST(MotionStreams, SendOnlyAsManyPointsAsTheBusThreadHasReportedRoomFor) {
  StreamsAlone alone;
  std::vector<motion_point_t> points;
  for (int i = 0; i < 200; ++i) points.push_back(StreamsAlone::point(i * StreamsAlone::period));
  ASSERT_TRUE(alone.add(0, points, 98, 98));
  EXPECT_EQ(alone.sent, motion::StreamPlayer::capacity);
  ASSERT_TRUE(alone.add(0, points, StreamsAlone::begin + 10, StreamsAlone::begin + 8));
  EXPECT_EQ(alone.sent, motion::StreamPlayer::capacity + 8);
}

TEST(MotionStreams, CheckAPointInABoundedTime) {
  StreamsAlone alone;
  const auto far = alone.add(0, {StreamsAlone::point(0.0), StreamsAlone::point(2.001)}, 98, 98);
  ASSERT_TRUE(far);
  EXPECT_EQ(far->why.substr(0, 46), "its point 1: its time is more than 10000 cycle");
  EXPECT_FALSE(alone.add(1, {StreamsAlone::point(1.999)}, 98, 98));
  const auto bad = alone.add(2, {StreamsAlone::point(2.999, {0.9, 0.9}, {2.0, 9.0})}, 98, 98);
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->axis, 1U) << "the way of the second axis, before the stops of the first";
}

}  // namespace
}  // namespace takt
