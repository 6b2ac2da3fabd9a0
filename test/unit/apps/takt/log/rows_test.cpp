#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <span>
#include <string>
#include <vector>

#include "apps/takt/log/frame_rows.hpp"
#include "apps/takt/log/image_rows.hpp"
#include "apps/takt/log/logged_signal.hpp"

namespace takt::logging {
namespace {

using testing::ElementsAre;

signal_t make_signal(const char* node, const char* name) {
  signal_t signal{};
  signal.node = node;
  signal.name = name;
  signal.data_type = static_cast<std::int16_t>(DataType::integer32);
  signal.bits = 32;
  signal.scale = 1.0;
  return signal;
}

const std::vector<signal_t> layout{make_signal("shoulder", "statusword"),
                                   make_signal("elbow", "statusword"),
                                   make_signal("shoulder", "position_actual_value"),
                                   make_signal("elbow", "position_actual_value")};

std::vector<std::string> names(const std::vector<std::string>& patterns) {
  std::vector<std::string> found;
  const auto chosen = choose_signals(layout, patterns);
  EXPECT_TRUE(chosen) << chosen.error();
  for (const LoggedSignal& signal : *chosen) found.push_back(signal.full_name());
  return found;
}

std::string refusal(const std::string& pattern) {
  const auto chosen = choose_signals(layout, {pattern});
  return chosen ? "accepted" : chosen.error();
}

template <class T>
std::vector<int> list(std::span<const T> values) {
  std::vector<int> all;
  for (const T value : values) all.push_back(static_cast<int>(value));
  return all;
}

TEST(ChooseSignals, InTheOrderOfThePatterns) {
  EXPECT_EQ(names({}).size(), 4U);
  EXPECT_THAT(
      names({"elbow.statusword", "shoulder.*", "*.statusword"}),
      ElementsAre("elbow.statusword", "shoulder.statusword", "shoulder.position_actual_value"));
  EXPECT_EQ(choose_signals(layout, {"elbow.pos*"})->front().position, 3U);
}

TEST(ChooseSignals, SuggestsWhatIsMeant) {
  EXPECT_EQ(refusal("sholder.*"), "no signal matches 'sholder.*', did you mean `shoulder.*`?");
  EXPECT_EQ(refusal("elbow"),
            "no signal matches 'elbow', did you mean `elbow.*` (all signals of this node)?");
  EXPECT_EQ(refusal("elbow.statuswrd"),
            "no signal matches 'elbow.statuswrd', did you mean `elbow.statusword`?");
  EXPECT_EQ(refusal("zzz.qqq"),
            "no signal matches 'zzz.qqq'; `takt top` shows the names of all signals");
}

std::string value(ValueFormat format, std::int64_t raw) {
  std::string out;
  return append_value(out, format, raw) ? out : "none";
}

TEST(AppendValue, HasTheDigitsOfTheRawValue) {
  EXPECT_EQ(value({.type = DataType::unsigned16, .bits = 16}, 0xFFFF), "65535");
  EXPECT_EQ(value({.type = DataType::unsigned64, .bits = 64}, -1), "18446744073709551615");
  EXPECT_EQ(value({.type = DataType::integer32, .scale = 1e-3}, 1234), "1.234");
  EXPECT_EQ(value({.type = DataType::integer32, .scale = 1e-3}, 2'147'483'647), "2147483.647");
  EXPECT_EQ(value({.type = DataType::integer32, .scale = 0.1, .offset = -40}, 700), "30");
  EXPECT_EQ(value({.type = DataType::real32, .bits = 32}, 0x3DCCCCCD), "0.1");
  EXPECT_EQ(value({.type = DataType::real64, .bits = 64}, 0x3FB999999999999A), "0.1");
  EXPECT_EQ(value({.type = DataType::real32, .bits = 32}, 0x7F800000), "none");
}

image_t make_image(std::int64_t cycle, std::int16_t part, std::int16_t parts, std::int32_t first,
                   std::vector<std::int64_t> values, std::vector<std::int32_t> stale = {}) {
  image_t image{};
  image.utime = 1000 * cycle;
  image.sync_mono_ns = cycle;
  image.part = part;
  image.parts = parts;
  image.cycle = cycle;
  image.first_signal = first;
  image.num_values = static_cast<std::int32_t>(values.size());
  image.values = std::move(values);
  image.num_stale = static_cast<std::int32_t>(stale.size());
  image.stale = std::move(stale);
  return image;
}

TEST(ImageRows, JoinsTheParts) {
  ImageRows rows{*choose_signals(layout, {"elbow.*", "shoulder.statusword"})};
  EXPECT_FALSE(rows.take(make_image(7, 0, 2, 0, {10, 11})));
  const auto row = rows.take(make_image(7, 1, 2, 2, {12, 13}, {3}));
  ASSERT_TRUE(row);
  EXPECT_THAT(list(row->raw), ElementsAre(11, 13, 10));
  EXPECT_THAT(list(row->fresh), ElementsAre(1, 0, 1));
  EXPECT_EQ(row->cycle, 7);
  EXPECT_EQ(row->utime, 7000);
  EXPECT_EQ(row->lost, 0);
}

TEST(ImageRows, CountsMissingCyclesAndLeavesOutRepeatedOnes) {
  ImageRows rows{*choose_signals(layout, {})};
  const std::vector<std::int64_t> values{1, 2, 3, 4};
  EXPECT_EQ(rows.take(make_image(5, 0, 1, 0, values))->lost, 0);
  EXPECT_FALSE(rows.take(make_image(5, 0, 1, 0, values)));
  EXPECT_FALSE(rows.take(make_image(4, 0, 1, 0, values)));
  EXPECT_EQ(rows.take(make_image(9, 0, 1, 0, values))->lost, 3);
  EXPECT_FALSE(rows.take(make_image(10, 0, 2, 0, {1, 2})));  // its second part is lost
  EXPECT_EQ(rows.take(make_image(11, 0, 1, 0, values))->lost, 1);
}

TEST(ImageRows, HoldsAgainstForgedImages) {
  ImageRows rows{*choose_signals(layout, {})};
  EXPECT_FALSE(rows.take(make_image(1, 1, 2, 2, {1})));
  EXPECT_FALSE(rows.take(make_image(1, 0, 1, -1, {1})));
  EXPECT_TRUE(rows.take(make_image(2, 0, 1, 3, {1, 2, 3, 4, 5}, {-1, 4, 2'000'000'000})));
  EXPECT_TRUE(rows.take(make_image(3, 0, 1, 2'000'000'000, {1})));
}

/// Two signals of a TPDO 0x181 with 16 and 32 bits, the second one with a sign.
BusPlan small_plan() {
  BusPlan plan;
  plan.cycle.period = std::chrono::milliseconds{1};
  plan.pdos.fields = {{.signal = 0, .bit_offset = 0, .bits = 16},
                      {.signal = 2, .bit_offset = 16, .bits = 32, .sign_extend = true}};
  plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x181),
                             .node = *NodeId::from(1),
                             .length = 6,
                             .first_field = 0,
                             .field_count = 2});
  return plan;
}

const Frame sync = make_frame(CobId::base(0x80), {});
const Frame values = make_frame(CobId::base(0x181), {0x34, 0x12, 0xFE, 0xFF, 0xFF, 0xFF});

TEST(FrameRows, ARowGoesFromSyncToSync) {
  FrameRows rows{small_plan(), *choose_signals(layout, {"shoulder.*"})};
  EXPECT_FALSE(rows.take(values, 500));  // before the first SYNC
  EXPECT_FALSE(rows.take(sync, 1000));
  EXPECT_FALSE(rows.take(values, 1100));
  const auto first = rows.take(sync, 2000);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->cycle, 0);
  EXPECT_EQ(first->utime, 1000);
  EXPECT_THAT(list(first->raw), ElementsAre(0x1234, -2));
  EXPECT_THAT(list(first->fresh), ElementsAre(1, 1));
  const auto second = rows.take(sync, 5100);
  EXPECT_THAT(list(second->fresh), ElementsAre(0, 0));
  const auto third = rows.finish();
  EXPECT_EQ(third->cycle, 4);
  EXPECT_EQ(third->lost, 2);
  EXPECT_FALSE(rows.finish());
}

TEST(FrameRows, AShortFrameGivesTheValuesThatItHas) {
  FrameRows rows{small_plan(), *choose_signals(layout, {"shoulder.*"})};
  rows.take(sync, 0);
  rows.take(make_frame(CobId::base(0x181), {0x01, 0x02, 0x03}), 10);
  EXPECT_THAT(list(rows.finish()->fresh), ElementsAre(1, 0));
}

TEST(FrameRows, WithoutSyncARowIsAPeriodLong) {
  BusPlan plan = small_plan();
  plan.cycle.sync = false;
  FrameRows rows{plan, *choose_signals(layout, {"shoulder.*"})};
  EXPECT_FALSE(rows.take(values, 0));
  EXPECT_FALSE(rows.take(values, 900));
  EXPECT_TRUE(rows.take(values, 1000));
}

}  // namespace
}  // namespace takt::logging
