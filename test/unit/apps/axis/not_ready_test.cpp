#include "apps/axis/not_ready.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using test::image;
using test::signal;
using test::two_axes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

enum class Mapped : std::uint8_t { display, both };

/// Returns the hint for an axis whose 6061 has this value.
std::string hint_for(Mapped mapped, std::int64_t shown, std::vector<std::int32_t> stale = {}) {
  layout_t layout = two_axes();
  layout.signals[1] = signal(5, 0x6061, false, 8);
  if (mapped == Mapped::both) layout.signals[5] = signal(5, 0x6060, true, 8);
  image_t values = image(1, {0x0250, shown, 0, 0});
  values.num_stale = static_cast<std::int32_t>(stale.size());
  values.stale = std::move(stale);
  ImageInput input;
  input.take(layout);
  input.take(values);
  AxisControl axes;
  axes.set_layout(input);
  return mode_hint(axes.signals(0), input, DriveMode::cyclic_position);
}

TEST(ModeHint, SaysWhatSetsAModeThatNobodySets) {
  EXPECT_THAT(
      hint_for(Mapped::display, 0),
      AllOf(HasSubstr("no mode of operation is set (0x6061 shows 0)"),
            HasSubstr("no RPDO contains 0x6060: map 0x6060 into an RPDO, or write 8 to 0x6060 "
                      "under `sdo:`")));
  EXPECT_THAT(hint_for(Mapped::display, 1),
              HasSubstr("shows mode 1 instead of 8, and no RPDO contains "
                        "0x6060: map 0x6060 into an RPDO"));
}

TEST(ModeHint, SaysThatTheDriveDoesNotTakeTheModeThatIsCommanded) {
  EXPECT_THAT(hint_for(Mapped::both, 0),
              AllOf(HasSubstr("0x6061 shows mode 0 instead of 8, which 0x6060 commands"),
                    Not(HasSubstr("map 0x6060"))));
}

TEST(ModeHint, SaysThatTheModeHasNotCome) {
  EXPECT_THAT(hint_for(Mapped::display, 8, {1}),
              HasSubstr("0x6061 has not arrived, and no RPDO contains"));
  EXPECT_THAT(hint_for(Mapped::both, 8, {1}), HasSubstr("0x6061 has not arrived"));
}

TEST(ModeHint, IsSilentInTheMode) {
  EXPECT_THAT(hint_for(Mapped::display, 8), IsEmpty());
  EXPECT_THAT(hint_for(Mapped::both, 8), IsEmpty());
}

TEST(BlockingBits, AreThoseOfTheState) {
  EXPECT_THAT(blocking_bits(0x0231),
              HasSubstr("bit 1 (switched on) of its statusword 0x0231 is 0"));
  EXPECT_THAT(blocking_bits(0x0233), HasSubstr("bit 2 (operation enabled)"));
  EXPECT_THAT(blocking_bits(0x0217), HasSubstr("bit 5 (quick stop)"));
  EXPECT_THAT(blocking_bits(0x021F), HasSubstr("bit 3 (fault)"));
  EXPECT_THAT(blocking_bits(0x0237), IsEmpty());
}

TEST(BlockingBits, AreAlsoThoseOfTheSupplyAndOfTheOperator) {
  EXPECT_THAT(blocking_bits(0x0250), Not(HasSubstr("bit 4")));
  EXPECT_THAT(blocking_bits(0x0240), HasSubstr("bit 4 (voltage enabled) is 0"));
  EXPECT_THAT(blocking_bits(0x0050), HasSubstr("bit 9 (remote) is 0"));
}

}  // namespace
}  // namespace takt
