#include "eds_parser/table/output_limits.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(PlausibleSize, IsNeitherZeroNorTheEndOfAType) {
  for (const std::int64_t size : {1LL, 0xFFFELL, 0x1'0000LL, 0x7FFF'FFFELL}) {
    EXPECT_TRUE(plausible_size(size)) << size;
  }
  for (const std::int64_t size : {-1LL, 0LL, 0xFFFFLL, 0x7FFF'FFFFLL, 0xFFFF'FFFFLL}) {
    EXPECT_FALSE(plausible_size(size)) << size;
  }
}

}  // namespace
}  // namespace takt
