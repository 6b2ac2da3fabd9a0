#include <gtest/gtest.h>
#include <takt/image_input.hpp>

#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using test::image;
using test::two_axes;

ImageInput with_layout() {
  ImageInput input;
  input.take(two_axes());
  return input;
}

/// Makes one of two parts of a layout; part `part` has the signals [first, first + 4) of the whole.
layout_t half(layout_t layout, std::int16_t part) {
  layout.part = part;
  layout.parts = 2;
  layout.first_signal = part * 4;
  layout.signals.erase(layout.signals.begin() + (1 - part) * 4,
                       layout.signals.begin() + (2 - part) * 4);
  layout.num_signals = 4;
  return layout;
}

image_t half(image_t whole, std::int16_t part) {
  whole.part = part;
  whole.parts = 2;
  whole.first_signal = part * 4;
  whole.values.erase(whole.values.begin() + (1 - part) * 4, whole.values.begin() + (2 - part) * 4);
  whole.num_values = 4;
  return whole;
}

TEST(ImageInput, NeedsALayoutBeforeAnImageMeansSomething) {
  ImageInput input;
  EXPECT_FALSE(input.take(image(1, {1, 2, 3, 4})));
  EXPECT_TRUE(input.take(two_axes()));
  EXPECT_TRUE(input.take(image(1, {1, 2, 3, 4})));
  EXPECT_EQ(input.values()[3], 4);
  EXPECT_EQ(input.cycle(), 1);
}

TEST(ImageInput, SaysThatALayoutIsNewOnlyOnce) {
  ImageInput input = with_layout();
  EXPECT_FALSE(input.take(two_axes()));
}

TEST(ImageInput, PutsALayoutTogetherFromItsPartsInAnyOrder) {
  ImageInput input;
  EXPECT_FALSE(input.take(half(two_axes(), 1)));
  EXPECT_FALSE(input.take(half(two_axes(), 1)));
  EXPECT_TRUE(input.take(half(two_axes(), 0)));
  EXPECT_EQ(input.signals()[0].index, 0x6041);
  EXPECT_EQ(input.signals()[7].index, 0x607A);
}

TEST(ImageInput, PutsAnImageTogetherFromThePartsOfOneCycle) {
  ImageInput input = with_layout();
  EXPECT_FALSE(input.take(half(image(1, {1, 2, 3, 4}), 0)));
  EXPECT_TRUE(input.take(half(image(1, {1, 2, 3, 4}), 1)));
  EXPECT_EQ(input.values()[2], 3);
}

TEST(ImageInput, NeverMixesTwoCycles) {
  ImageInput input = with_layout();
  EXPECT_FALSE(input.take(half(image(1, {1, 2, 3, 4}), 0)));
  EXPECT_FALSE(input.take(half(image(2, {5, 6, 7, 8}), 1)));
  EXPECT_FALSE(input.take(half(image(1, {1, 2, 3, 4}), 1)));
  EXPECT_TRUE(input.take(half(image(2, {5, 6, 7, 8}), 0)));
  EXPECT_EQ(input.cycle(), 2);
}

TEST(ImageInput, LeavesOutOlderImages) {
  ImageInput input = with_layout();
  input.take(image(5, {5, 5, 5, 5}));
  EXPECT_FALSE(input.take(image(4, {4, 4, 4, 4})));
  EXPECT_FALSE(input.take(image(5, {6, 6, 6, 6})));
  EXPECT_EQ(input.values()[0], 5);
}

TEST(ImageInput, LeavesOutImagesOfAnotherSessionLayoutOrSchema) {
  ImageInput input = with_layout();
  image_t other = image(1, {1, 2, 3, 4});
  other.session = 78;
  EXPECT_FALSE(input.take(other));
  other = image(1, {1, 2, 3, 4});
  other.layout_hash = 9;
  EXPECT_FALSE(input.take(other));
  other = image(1, {1, 2, 3, 4});
  other.schema = 1;
  EXPECT_FALSE(input.take(other));
}

TEST(ImageInput, StartsAnewWithTheLayoutOfAnotherSession) {
  ImageInput input = with_layout();
  input.take(image(1000, {1, 2, 3, 4}));
  layout_t again = two_axes();
  again.session = 78;
  input.set_time(ImageInput::quiet_ns);
  EXPECT_TRUE(input.take(again));
  EXPECT_FALSE(input.has_image());
  image_t first = image(1, {1, 2, 3, 4});
  first.session = 78;
  EXPECT_TRUE(input.take(first));
}

TEST(ImageInput, SurvivesNumbersThatDoNotFit) {
  ImageInput input = with_layout();
  image_t bad = image(1, {1, 2, 3, 4});
  bad.first_signal = 1;
  EXPECT_FALSE(input.take(bad));
  bad.first_signal = -1;
  EXPECT_FALSE(input.take(bad));
  bad = image(1, {1, 2, 3, 4});
  bad.part = 1;
  EXPECT_FALSE(input.take(bad));
  bad = image(1, {1, 2, 3, 4});
  bad.parts = 0;
  EXPECT_FALSE(input.take(bad));
  bad = image(1, {1, 2, 3, 4});
  bad.stale = {-1, 8, 2};
  bad.num_stale = 3;
  EXPECT_TRUE(input.take(bad));
  EXPECT_TRUE(input.stale(2));
  layout_t layout = two_axes();
  layout.session = 79;
  layout.first_signal = 0x7FFFFFFF;
  EXPECT_FALSE(input.take(layout));
  layout.first_signal = 0;
  layout.total_signals = 0x7FFFFFFF;
  EXPECT_FALSE(input.take(layout));
  layout.total_signals = 0;
  EXPECT_FALSE(input.take(layout));
}

// The cycle 2^62 stands for the greatest cycle of a forged message, which a bus never reaches.
TEST(ImageInput, IsNotDeafenedByAForgedCycle) {
  constexpr std::int64_t forged = std::int64_t{1} << 62;
  ImageInput input = with_layout();
  EXPECT_TRUE(input.take(image(1, {1, 1, 1, 1})));
  EXPECT_FALSE(input.take(image(forged, {9, 9, 9, 9})));
  EXPECT_FALSE(input.take(image(0x7FFF'FFFF'FFFF'FFFF, {9, 9, 9, 9})));
  EXPECT_FALSE(input.take(image(-5, {9, 9, 9, 9})));
  EXPECT_TRUE(input.take(image(2, {2, 2, 2, 2})));
  EXPECT_EQ(input.values()[0], 2);
}

TEST(ImageInput, ComesBackFromAForgedCycleThatWasTheFirst) {
  ImageInput input = with_layout();
  EXPECT_TRUE(input.take(image(std::int64_t{1} << 62, {9, 9, 9, 9})));
  EXPECT_FALSE(input.take(image(7, {7, 7, 7, 7})));
  EXPECT_FALSE(input.take(image(8, {8, 8, 8, 8})));
  EXPECT_TRUE(input.take(image(9, {9, 9, 9, 9})));
  EXPECT_TRUE(input.take(image(10, {10, 10, 10, 10})));
  EXPECT_EQ(input.cycle(), 10);
}

TEST(ImageInput, GoesOnAfterALongGapOfItsOwn) {
  ImageInput input = with_layout();
  input.take(image(1, {1, 1, 1, 1}));
  EXPECT_FALSE(input.take(image(1'000'000, {7, 7, 7, 7})));
  EXPECT_FALSE(input.take(image(1'000'001, {8, 8, 8, 8})));
  EXPECT_TRUE(input.take(image(1'000'002, {9, 9, 9, 9})));
}

TEST(ImageInput, LateImagesNeverAddUpToAnotherBus) {
  ImageInput input = with_layout();
  input.take(image(100, {1, 1, 1, 1}));
  for (std::int64_t i = 1; i < 10; ++i) {
    EXPECT_FALSE(input.take(image(10 + i, {9, 9, 9, 9})));
    EXPECT_TRUE(input.take(image(100 + i, {2, 2, 2, 2})));
  }
  EXPECT_EQ(input.cycle(), 109);
}

layout_t forged_layout() {
  layout_t forged = two_axes();
  forged.session = 78;
  return forged;
}

TEST(ImageInput, KeepsToItsSessionWhileImagesOfItCome) {
  ImageInput input = with_layout();
  for (std::int64_t cycle = 1; cycle <= 500; ++cycle) {
    input.set_time(cycle * 2'000'000);
    input.take(image(cycle, {1, 2, 3, 4}));
    EXPECT_FALSE(input.take(forged_layout()));
  }
  layout_t other_hash = two_axes();
  other_hash.hash += 1;
  EXPECT_FALSE(input.take(other_hash));
  EXPECT_EQ(input.session(), test::session);
  EXPECT_TRUE(input.has_image());
}

TEST(ImageInput, TakesAnotherSessionWhenTheImagesOfItsOwnHaveCeased) {
  ImageInput input = with_layout();
  input.set_time(1'000'000'000);
  input.take(image(1, {1, 2, 3, 4}));
  input.set_time(1'000'000'000 + ImageInput::quiet_ns - 1);
  EXPECT_FALSE(input.take(forged_layout()));
  input.set_time(1'000'000'000 + ImageInput::quiet_ns);
  EXPECT_TRUE(input.take(forged_layout()));
  EXPECT_EQ(input.session(), 78);
  EXPECT_FALSE(input.has_image());
}

TEST(ImageInput, ComesBackFromASessionThatHasNoImages) {
  ImageInput input;
  EXPECT_TRUE(input.take(forged_layout()));
  EXPECT_TRUE(input.take(two_axes()));
  EXPECT_EQ(input.session(), test::session);
}

TEST(ImageInput, WaitsLongerWhereTheBusIsSlow) {
  ImageInput input;
  layout_t slow = two_axes();
  slow.period_ns = 100'000'000;
  input.take(slow);
  input.set_time(0);
  input.take(image(1, {1, 2, 3, 4}));
  input.set_time(1'999'999'999);  // 20 periods are 2 s
  EXPECT_FALSE(input.take(forged_layout()));
  input.set_time(2'000'000'000);
  EXPECT_TRUE(input.take(forged_layout()));
}

TEST(ImageInput, LeavesOutALayoutWithAPeriodThatNoBusHas) {
  ImageInput input;
  layout_t forged = two_axes();
  forged.period_ns = 1LL << 62U;
  EXPECT_FALSE(input.take(forged));
}

}  // namespace
}  // namespace takt
