#include "eds_parser/plan/frame_time.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using std::chrono::nanoseconds;

TEST(FrameTime, WorstCasesAreThoseOfDavisAndBurns) {
  EXPECT_EQ(worst_frame_bits(0), 55U);
  EXPECT_EQ(worst_frame_bits(1), 65U);
  EXPECT_EQ(worst_frame_bits(6), 115U);
  EXPECT_EQ(worst_frame_bits(8), 135U);
  EXPECT_EQ(worst_frame_bits(0, true), 80U);
  EXPECT_EQ(worst_frame_bits(5, true), 130U);
  EXPECT_EQ(worst_frame_bits(8, true), 160U);
}

TEST(FrameTime, ShortestFramesHaveNoStuffBit) {
  EXPECT_EQ(shortest_frame_bits(0), 47U);
  EXPECT_EQ(shortest_frame_bits(8), 111U);
  EXPECT_EQ(shortest_frame_bits(8, true), 131U);
}

TEST(FrameTime, TimeOnTheWireFollowsTheBitRate) {
  EXPECT_EQ(wire_time(135, 1'000'000), nanoseconds{135'000});
  EXPECT_EQ(wire_time(135, 500'000), nanoseconds{270'000});
  EXPECT_EQ(wire_time(135, 800'000), nanoseconds{168'750});
  EXPECT_EQ(wire_time(1, 3), nanoseconds{333'333'334});
}

}  // namespace
}  // namespace takt
