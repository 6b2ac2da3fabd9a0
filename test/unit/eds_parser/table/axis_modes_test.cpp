#include "eds_parser/table/axis_modes.hpp"

#include <gtest/gtest.h>
#include <set>

namespace takt {
namespace {

std::set<int> modes_that_follow(AxisQuantity quantity) {
  std::set<int> modes;
  for (int mode = 1; mode <= 10; ++mode) {
    if (follows(quantity, mode)) modes.insert(mode);
  }
  return modes;
}

TEST(AxisModes, AnAxisFollowsTheQuantityThatLeadsIt) {
  EXPECT_EQ(modes_that_follow(AxisQuantity::position), (std::set{5, 7, 8}));
  EXPECT_EQ(modes_that_follow(AxisQuantity::velocity), (std::set{3, 5, 9}));
  EXPECT_EQ(modes_that_follow(AxisQuantity::torque), (std::set{4, 5, 10}));
  EXPECT_EQ(modes_that_follow(AxisQuantity::none).size(), 10U);
}

TEST(AxisModes, AModeOfTheManufacturerFollowsEach) {
  for (const AxisQuantity quantity :
       {AxisQuantity::position, AxisQuantity::velocity, AxisQuantity::torque}) {
    for (const int mode : {-128, -1, 0, 11, 127, 0xFF}) {
      EXPECT_TRUE(follows(quantity, mode)) << mode;
    }
  }
}

}  // namespace
}  // namespace takt
