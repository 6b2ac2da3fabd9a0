#include "apps/axis/stream/stream_buffer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

namespace takt {
namespace {

using ::testing::HasSubstr;

constexpr double period = 0.01;

motion_point_t at(double time) {
  motion_point_t point{};
  point.time = time;
  point.position = {time};
  point.velocity = {0.0};
  return point;
}

class PointsOfAStream : public ::testing::Test {
 protected:
  /// Appends points that are 0.1 s apart.
  void add_until(double time) {
    for (int i = 1; 0.1 * i < time + 0.01; ++i) EXPECT_EQ(buffer_.add(at(0.1 * i)), "");
  }
  /// Returns the numbers of the first point and of the one behind the last; both are 0 if nothing
  /// is due.
  std::pair<std::int64_t, std::int64_t> sent(std::int64_t cycle) {
    motion_stream_t message{};
    if (!buffer_.fill(cycle, message)) return {0, 0};
    return {message.first_point,
            message.first_point + static_cast<std::int64_t>(message.points.size())};
  }

  StreamBuffer buffer_{{0.0}, period};
};

using Numbers = std::pair<std::int64_t, std::int64_t>;
constexpr Numbers nothing{0, 0};

TEST_F(PointsOfAStream, WaitUntilEnoughAreThere) {
  add_until(0.3);
  EXPECT_TRUE(buffer_.has_room());
  EXPECT_EQ(sent(100), nothing);
  EXPECT_EQ(buffer_.add(at(0.4)), "");
  EXPECT_FALSE(buffer_.has_room());
  EXPECT_EQ(sent(101), Numbers(0, 5)) << "with the point where the axes stand";
}

TEST_F(PointsOfAStream, AreSentInTimeAndRepeatedUntilTheyAreReached) {
  add_until(2.0);
  ASSERT_EQ(sent(100), Numbers(0, 5));
  EXPECT_EQ(sent(104), nothing);
  EXPECT_EQ(sent(105), Numbers(0, 5)) << "the message may be lost";
  buffer_.observe(115, 0.3);
  EXPECT_EQ(sent(115), Numbers(1, 6)) << "0.1 s have passed";
}

/// At 0.1 s, the report says 0.2 s. The points end at 0.3 s for the bus thread, and not at 0.4 s.
TEST_F(PointsOfAStream, ThatHaveNotArrivedAreNotTakenForReached) {
  add_until(2.0);
  ASSERT_EQ(sent(100), Numbers(0, 5));
  buffer_.observe(110, 0.2);
  EXPECT_EQ(sent(111).first, 1);
  buffer_.observe(112, 0.2);
  EXPECT_EQ(sent(117).first, 1);
}

TEST_F(PointsOfAStream, AreNotRepeatedShortlyBeforeTheyEnd) {
  add_until(0.3);
  buffer_.finish();
  ASSERT_EQ(sent(100), Numbers(0, 4));
  buffer_.observe(115, 0.15);
  EXPECT_EQ(sent(115), Numbers(1, 4));
  buffer_.observe(121, 0.09);
  EXPECT_EQ(sent(121), nothing);
}

TEST_F(PointsOfAStream, AreNotMoreThanTaktdHolds) {
  for (int i = 1; i <= 100; ++i) EXPECT_EQ(buffer_.add(at(0.001 * i)), "");
  EXPECT_EQ(sent(100), Numbers(0, StreamBuffer::most_waiting + 1));
}

TEST_F(PointsOfAStream, MayBeginWithThatWhereTheAxesStand) {
  EXPECT_EQ(buffer_.add(at(0.0)), "");
  EXPECT_FALSE(buffer_.has_points());
  EXPECT_THAT(buffer_.add(at(5.0)), HasSubstr("point 1 of the stream is at 5 s"));
}

}  // namespace
}  // namespace takt
