#include "apps/takt/smooth/image_record.hpp"

#include <gtest/gtest.h>

namespace takt::smooth {
namespace {

signal_t signal(std::int32_t index, bool output) {
  signal_t out{};
  out.node = "lift";
  out.node_id = 5;
  out.index = index;
  out.output = output ? 1 : 0;
  out.bits = 32;
  return out;
}

image_t image(std::int64_t cycle, std::int64_t position, std::int64_t target) {
  image_t out{};
  out.cycle = cycle;
  out.values = {position, target};
  out.num_values = 2;
  return out;
}

TEST(ImageRecord, HasOneSetPointInEachCycle) {
  ImageRecord record{
      "bus 'demo'", {signal(0x6064, false), signal(0x607A, true)}, std::chrono::milliseconds{2}};
  record.take(image(100, 1, 2));
  record.take(image(101, 3, 4));
  image_t stale = image(103, 5, 6);
  stale.stale = {0};
  stale.num_stale = 1;
  record.take(stale);

  const BusRecord bus = record.finish();

  ASSERT_EQ(bus.axes.size(), 1U);
  EXPECT_EQ(bus.axes[0].name, "lift");
  ASSERT_EQ(bus.axes[0].set_points.size(), 3U);
  EXPECT_EQ(bus.axes[0].set_points[2].value, 6);
  EXPECT_EQ(bus.axes[0].positions.size(), 2U);
  ASSERT_EQ(bus.syncs.size(), 3U);
  EXPECT_EQ(bus.syncs[2], std::chrono::milliseconds{6});
  EXPECT_FALSE(bus.with_times);
}

TEST(ImageRecord, LeavesOutAnImageOfAnEarlierCycle) {
  ImageRecord record{
      "bus 'demo'", {signal(0x6064, false), signal(0x607A, true)}, std::chrono::milliseconds{2}};
  record.take(image(100, 1, 2));
  record.take(image(99, 1, 2));

  EXPECT_EQ(record.finish().syncs.size(), 1U);
}

}  // namespace
}  // namespace takt::smooth
