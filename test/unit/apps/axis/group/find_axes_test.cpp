#include "apps/axis/group/find_axes.hpp"

#include <gtest/gtest.h>

#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using test::signal;

TEST(AxisSignals, FindsTheSecondAxisOfADevice) {
  const std::vector signals{signal(5, 0x6041, false, 16), signal(5, 0x6040, true, 16),
                            signal(5, 0x6841, false, 16), signal(5, 0x6840, true, 16),
                            signal(5, 0x687A, true, 32)};
  const auto axes = find_axes(signals);

  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[1].name, "shoulder.2");
  EXPECT_EQ(axes[1].target_position, 4U);
  EXPECT_EQ(axes[0].target_position, std::nullopt);
}

TEST(AxisSignals, APointOfInterpolationIsTheTargetWhereNoTargetPositionIsMapped) {
  signal_t point = signal(5, 0x60C1, true, 32);
  point.sub = 1;
  std::vector signals{signal(5, 0x6041, false, 16), signal(5, 0x6040, true, 16), point};
  auto axes = find_axes(signals);
  ASSERT_EQ(axes.size(), 1U);
  EXPECT_EQ(axes[0].target_position, 2U);
  EXPECT_TRUE(axes[0].interpolates);

  signals.insert(signals.begin() + 2, signal(5, 0x607A, true, 32));
  axes = find_axes(signals);
  EXPECT_EQ(axes[0].target_position, 2U);
  EXPECT_FALSE(axes[0].interpolates);
}

TEST(AxisSignals, LeavesOutWhatIsNoAxis) {
  const std::vector signals{signal(5, 0x6041, false, 16),  // no controlword
                            signal(6, 0x6000, false, 8), signal(6, 0x6200, true, 8)};
  EXPECT_TRUE(find_axes(signals).empty());
}

}  // namespace
}  // namespace takt
