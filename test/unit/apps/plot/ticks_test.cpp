#include "apps/plot/ticks.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(Ticks, AreRoundAndEncloseTheRange) {
  const Ticks ticks = enclosing_ticks(-0.13, 0.42, 4);
  EXPECT_DOUBLE_EQ(ticks.step, 0.2);
  EXPECT_DOUBLE_EQ(ticks.low(), -0.2);
  EXPECT_DOUBLE_EQ(ticks.high(), 0.6000000000000001);
  EXPECT_EQ(ticks.text(ticks.values[0]), "-0.2");
  EXPECT_EQ(ticks.text(ticks.values[1]), "0");
}

TEST(Ticks, HaveARangeWhereAllValuesAreEqual) {
  EXPECT_LT(enclosing_ticks(0.0, 0.0, 4).low(), 0.0);
  EXPECT_GT(enclosing_ticks(7.0, 7.0, 4).high(), 7.0);
  EXPECT_LT(enclosing_ticks(-7.0, -7.0, 4).low(), -7.0);
}

TEST(Ticks, WriteLargeAndSmallNumbersShort) {
  EXPECT_EQ(enclosing_ticks(0.0, 5e6, 4).text(2e6), "2e+06");
  EXPECT_EQ(enclosing_ticks(0.0, 4e-8, 4).text(1e-8), "1e-08");
  EXPECT_EQ(enclosing_ticks(0.0, 100.0, 4).text(50.0), "50");
}

}  // namespace
}  // namespace takt
