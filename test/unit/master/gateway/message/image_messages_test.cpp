#include "master/gateway/message/image_messages.hpp"

#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "master/gateway/message/bus_view.hpp"
#include "master/lcm/messages.hpp"
#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

BusPlan large_plan(std::size_t signals) {
  BusPlan plan = test::a_plan();
  const Signal signal = plan.layout.signals[0];
  plan.layout.signals.assign(signals, signal);
  plan.layout.inputs = signals;
  return plan;
}

ImageView view_of(std::uint64_t cycle, const std::vector<std::int64_t>& values,
                  const std::vector<std::uint64_t>& stale) {
  ImageView view;
  view.cycle = cycle;
  view.sync_time = std::chrono::seconds{3};
  view.values = values;
  view.stale_bits = stale;
  return view;
}

TEST(ImageMessages, CarryValuesTimesAndStaleSignals) {
  ImageMessages messages{test::a_plan(), 42};

  const auto& parts = messages.fill(view_of(9, {1, 2, 3, 4}, {0b0101}), std::chrono::seconds{1000});

  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].cycle, 9);
  EXPECT_EQ(parts[0].session, 42);
  EXPECT_EQ(parts[0].layout_hash, 77);
  EXPECT_EQ(parts[0].utime, 1'003'000'000);
  EXPECT_EQ(parts[0].sync_mono_ns, 3'000'000'000);
  EXPECT_EQ(parts[0].values, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(parts[0].stale, (std::vector<std::int32_t>{0, 2}));
}

TEST(ImageMessages, LargeImagesStayBelowOneDatagramAndComeBackWhole) {
  const BusPlan plan = large_plan(1000);
  ImageMessages messages{plan, 42};
  std::vector<std::int64_t> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int64_t>(i) * 3;
  const std::vector<std::uint64_t> all_stale(16, ~std::uint64_t{0});
  std::vector<std::byte> buffer;
  BusView bus;

  for (const layout_t& part : layout_messages(plan, 42)) {
    EXPECT_LE(encode(part, buffer).size(), 1350U);
    bus.take(part);
  }
  for (const image_t& part : messages.fill(view_of(5, values, all_stale), {})) {
    EXPECT_LE(encode(part, buffer).size(), 1300U);
    bus.take(part);
  }

  EXPECT_EQ(bus.values(), values);
  EXPECT_TRUE(bus.stale(999));
  EXPECT_EQ(bus.cycle(), 5);
}

TEST(ImageMessages, ImageWithALostPartIsNotShown) {
  const BusPlan plan = large_plan(300);
  ImageMessages messages{plan, 42};
  BusView bus;
  for (const layout_t& part : layout_messages(plan, 42)) bus.take(part);

  const auto& parts = messages.fill(view_of(5, std::vector<std::int64_t>(300), {}), {});
  ASSERT_EQ(parts.size(), 3U);
  bus.take(parts[0]);
  bus.take(parts[2]);

  EXPECT_EQ(bus.images(), 0U);
}

}  // namespace
}  // namespace takt
