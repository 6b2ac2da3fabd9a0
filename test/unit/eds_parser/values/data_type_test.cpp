#include "eds_parser/values/data_type.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace takt {
namespace {

// The names in CiA 301, table 44, say what a type is.
TEST(DataType, AsItsNameSays) {
  for (unsigned code = 0; code <= 0x20; ++code) {
    const auto type = static_cast<DataType>(code);
    const std::string text{name(type)};
    EXPECT_EQ(is_signed(type), text.starts_with("INTEGER")) << text;
    EXPECT_EQ(is_real(type), text.starts_with("REAL")) << text;
    const auto digits = text.find_first_of("0123456789");
    if (digits != std::string::npos) {
      EXPECT_EQ(bit_width(type), std::stoul(text.substr(digits))) << text;
    }
  }
}

TEST(Real32, HasAnEnd) {
  constexpr double most = std::numeric_limits<float>::max();
  constexpr double largest = std::numeric_limits<double>::max();
  for (const double sign : {1.0, -1.0}) {
    EXPECT_FALSE(exceeds_real32(sign * most));
    EXPECT_TRUE(exceeds_real32(sign * std::nextafter(most, largest)));
    EXPECT_TRUE(exceeds_real32(sign * largest));
    EXPECT_FALSE(exceeds_real32(sign * std::numeric_limits<double>::infinity()));
  }
  EXPECT_FALSE(exceeds_real32(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace takt
