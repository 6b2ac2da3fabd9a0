#include "master/sim/axis/axis_objects.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

class Slots : public testing::Test {
 protected:
  ObjectStore store_{SampleDevice{1_node}
                         .object(0x2000, 0, DataType::integer16, Access::rw, 0xFFFE)
                         .text(0x2001, 0, "text")
                         .build()};
};

TEST_F(Slots, ReadAndWriteTheObject) {
  Slot slot{store_, {0x2000, 0}, 7};
  EXPECT_TRUE(slot.exists());
  EXPECT_EQ(slot.get(), -2);
  slot.set(0x1'0003);
  EXPECT_EQ(store_.number({0x2000, 0}), 3);
}

TEST_F(Slots, AreConstantsWithoutANumericObject) {
  for (const std::uint16_t index : {std::uint16_t{0x2001}, std::uint16_t{0x3000}}) {
    const Slot slot{store_, {index, 0}, -7};
    EXPECT_FALSE(slot.exists());
    EXPECT_EQ(slot.get(), -7);
    EXPECT_EQ(slot.positive_or(1.5), 1.5);
  }
  EXPECT_EQ(store_.find({0x3000, 0}), nullptr);
}

TEST_F(Slots, KeepTheirZeroWithoutAnObject) {
  Slot slot{store_, {0x3000, 0}};
  slot.set(5);
  EXPECT_EQ(slot.get(), 0);
}

}  // namespace
}  // namespace takt::sim
