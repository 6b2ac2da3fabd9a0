#include "eds_parser/specification/object_units.hpp"

#include <gtest/gtest.h>
#include <ios>

namespace takt {
namespace {

struct Row {
  Quantity quantity;
  bool directed;
  bool absolute;
  std::vector<std::uint16_t> objects;
};

// CiA 402-2: offsets and differences of positions have no origin; windows, limits and ramps no
// sign.
const Row rows[]{
    {Quantity::position,
     true,
     true,
     {0x6062, 0x6064, 0x607A, 0x607B, 0x607D, 0x60BA, 0x60BB, 0x60BC, 0x60BD, 0x60C1, 0x60FC}},
    {Quantity::position, true, false, {0x607C, 0x60B0, 0x60F4}},
    {Quantity::position, false, false, {0x6065, 0x6067}},
    {Quantity::velocity, true, false, {0x606B, 0x606C, 0x60B1, 0x60FF}},
    {Quantity::velocity, false, false, {0x606D, 0x606F, 0x607F, 0x6081, 0x6082, 0x6099, 0x60F8}},
    {Quantity::acceleration, false, false, {0x6083, 0x6084, 0x6085, 0x609A, 0x60C5, 0x60C6}},
    {Quantity::torque, true, false, {0x6071, 0x6074, 0x6077, 0x60B2}},
    {Quantity::torque, false, false, {0x6072, 0x60E0, 0x60E1}}};

TEST(ObjectUnits, EachObjectOfADriveHasItsQuantityOnEachAxis) {
  for (const Row& row : rows) {
    for (const unsigned first : row.objects) {
      for (unsigned axis = 0; axis < 8; ++axis) {
        const auto index = static_cast<std::uint16_t>(first + 0x800 * axis);
        const auto found = quantity_of({index, 0});
        ASSERT_TRUE(found) << std::hex << index;
        EXPECT_EQ(found->quantity, row.quantity) << std::hex << index;
        EXPECT_EQ(found->directed, row.directed) << std::hex << index;
        EXPECT_EQ(found->absolute, row.absolute) << std::hex << index;
      }
    }
  }
}

TEST(ObjectUnits, OtherObjectsHaveNone) {
  for (const unsigned index : {0x2071U, 0x5FFFU, 0x6040U, 0x6041U, 0x6060U, 0xA071U}) {
    EXPECT_FALSE(quantity_of({static_cast<std::uint16_t>(index), 0})) << std::hex << index;
  }
}

}  // namespace
}  // namespace takt
