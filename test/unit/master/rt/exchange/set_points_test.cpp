#include "master/rt/exchange/set_points.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <thread>

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(SetPoints, ShowNothingBeforePublish) {
  SetPoints points{2};
  points.set(0, 5);
  EXPECT_EQ(points.newest().points[0].generation, 0U);
  points.publish(3ms);
  EXPECT_EQ(points.newest().points[0].value, 5);
  EXPECT_EQ(points.newest().when, 3ms);
}

TEST(SetPoints, NewestSetWins) {
  SetPoints points{1};
  for (int i = 1; i <= 5; ++i) {
    points.set(0, i);
    points.publish(Time{i});
  }
  EXPECT_EQ(points.newest().points[0].value, 5);
  EXPECT_EQ(points.newest().points[0].generation, 5U);
}

TEST(SetPoints, KeepWhatWasStagedBefore) {
  SetPoints points{2};
  points.set(0, 1);
  points.publish(1ms);
  points.set(1, 2);
  points.publish(2ms);
  const SetPointFrame& newest = points.newest();
  EXPECT_EQ(newest.points[0].value, 1);
  EXPECT_EQ(newest.points[0].generation, 1U);
  EXPECT_EQ(newest.points[1].value, 2);
}

TEST(SetPoints, StampEachCommandWhenItIsHandedOver) {
  SetPoints points{2};
  points.set(0, 1);
  points.publish(1ms);
  points.set(1, 2);
  points.publish(9ms);
  EXPECT_EQ(points.newest().points[0].when, 1ms);
  EXPECT_EQ(points.newest().points[1].when, 9ms);
}

TEST(SetPoints, EqualValueIsANewCommand) {
  SetPoints points{1};
  points.set(0, 7);
  points.publish(1ms);
  const std::uint32_t before = points.newest().points[0].generation;
  points.set(0, 7);
  points.publish(2ms);
  EXPECT_NE(points.newest().points[0].generation, before);
}

TEST(SetPoints, AreNeverTornBetweenTwoThreads) {
  constexpr std::size_t outputs = 100;
  SetPoints points{outputs};
  std::atomic<bool> done{false};
  std::thread front{[&] {
    for (std::int64_t i = 1; i <= 20000; ++i) {
      for (std::size_t output = 0; output < outputs; ++output) points.set(output, i);
      points.publish(Time{i});
    }
    done = true;
  }};
  std::int64_t newest = 0;
  for (bool last = false; !last;) {
    last = done;
    const SetPointFrame& frame = points.newest();
    ASSERT_GE(frame.when.count(), newest);
    newest = frame.when.count();
    for (const SetPoint& point : frame.points) ASSERT_EQ(point.value, newest);
  }
  front.join();
  EXPECT_EQ(newest, 20000);
}

}  // namespace
}  // namespace takt
