#include "master/units/units.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace takt {
namespace {

constexpr double pi = 3.14159265358979323846;

TEST(Units, RawIsScaledAndShifted) {
  const std::array<ValueFormat, 3> formats{
      ValueFormat{.type = DataType::integer32, .bits = 32, .scale = 2 * pi / 65536, .offset = 0},
      ValueFormat{.type = DataType::integer16, .bits = 16, .scale = -0.5, .offset = 10},
      ValueFormat{.type = DataType::unsigned8, .bits = 8, .scale = 1, .offset = 0}};
  const Units units{formats};
  Eigen::ArrayXd si{3};

  units.to_si(std::array<std::int64_t, 3>{32768, -4, 255}, si);

  EXPECT_DOUBLE_EQ(si[0], pi);
  EXPECT_DOUBLE_EQ(si[1], 12.0);
  EXPECT_DOUBLE_EQ(si[2], 255.0);
}

TEST(Units, RealsAndUnsigned64AreBitPatterns) {
  const std::array<ValueFormat, 3> formats{
      ValueFormat{.type = DataType::real32, .bits = 32, .scale = 2, .offset = 1},
      ValueFormat{.type = DataType::real64, .bits = 64, .scale = 1, .offset = 0},
      ValueFormat{.type = DataType::unsigned64, .bits = 64, .scale = 1, .offset = 0}};
  const Units units{formats};
  Eigen::ArrayXd si{3};

  // 1.5f = 3FC0 0000, -2.0 = C000 0000 0000 0000
  units.to_si(std::array<std::int64_t, 3>{0x3FC0'0000,
                                          static_cast<std::int64_t>(0xC000'0000'0000'0000), -1},
              si);

  EXPECT_DOUBLE_EQ(si[0], 4.0);
  EXPECT_DOUBLE_EQ(si[1], -2.0);
  EXPECT_DOUBLE_EQ(si[2], 18446744073709551616.0);
  EXPECT_EQ(units.to_raw(0, 4.0), 0x3FC0'0000);
  EXPECT_EQ(units.to_raw(1, -2.0), static_cast<std::int64_t>(0xC000'0000'0000'0000));
}

TEST(Units, BackToRawIsRoundedAndHeldInsideItsBits) {
  const std::array<ValueFormat, 2> formats{
      ValueFormat{.type = DataType::integer16, .bits = 16, .scale = 0.001, .offset = 0},
      ValueFormat{.type = DataType::unsigned8, .bits = 4, .scale = 1, .offset = 0}};
  const Units units{formats};

  EXPECT_EQ(units.to_raw(0, 1.2346), 1235);
  EXPECT_EQ(units.to_raw(0, -1.2346), -1235);
  EXPECT_EQ(units.to_raw(0, 1e9), 32767);
  EXPECT_EQ(units.to_raw(0, -1e9), -32768);
  EXPECT_EQ(units.to_raw(0, std::numeric_limits<double>::infinity()), 32767);
  EXPECT_EQ(units.to_raw(0, std::nan("")), 0);
  EXPECT_EQ(units.to_raw(1, 20), 15);
  EXPECT_EQ(units.to_raw(1, -1), 0);
}

TEST(Units, SixtyFourBitsDoNotOverflow) {
  const std::array<ValueFormat, 2> formats{
      ValueFormat{.type = DataType::integer64, .bits = 64, .scale = 1, .offset = 0},
      ValueFormat{.type = DataType::unsigned64, .bits = 64, .scale = 1, .offset = 0}};
  const Units units{formats};

  EXPECT_EQ(units.to_raw(0, 1e300), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(units.to_raw(0, -1e300), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(units.to_raw(1, 1e300), -1);
  EXPECT_EQ(units.to_raw(1, -5), 0);
}

TEST(Units, ValuesThatDoNotFitAreKnown) {
  EXPECT_TRUE(fits(DataType::integer16, 16, -32768));
  EXPECT_FALSE(fits(DataType::integer16, 16, -32769));
  EXPECT_FALSE(fits(DataType::integer16, 16, 32768));
  EXPECT_TRUE(fits(DataType::unsigned32, 32, 4294967295));
  EXPECT_FALSE(fits(DataType::unsigned32, 32, -1));
  EXPECT_TRUE(fits(DataType::real32, 32, 0xFFC0'0000));
  EXPECT_FALSE(fits(DataType::real32, 32, -1));
  EXPECT_TRUE(fits(DataType::unsigned64, 64, -1));
  EXPECT_TRUE(fits(DataType::boolean, 1, 1));
  EXPECT_FALSE(fits(DataType::boolean, 1, 2));
}

}  // namespace
}  // namespace takt
