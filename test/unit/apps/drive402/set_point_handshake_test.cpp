#include "apps/drive402/set_point_handshake.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

constexpr std::uint16_t free_buffer = 0x0237;
constexpr std::uint16_t acknowledged = 0x1237;

TEST(SetPointHandshake, HoldsBit4UntilBit12AnswersAndEndsWhenBit12Falls) {
  SetPointHandshake handshake;
  handshake.begin();

  EXPECT_EQ(handshake.step(free_buffer), 0x0030);
  EXPECT_EQ(handshake.step(free_buffer), 0x0030);
  EXPECT_EQ(handshake.step(acknowledged), 0x0020);
  EXPECT_FALSE(handshake.done());
  EXPECT_EQ(handshake.step(acknowledged), 0x0020);
  EXPECT_EQ(handshake.step(free_buffer), 0x0020);
  EXPECT_TRUE(handshake.done());
}

TEST(SetPointHandshake, ASetPointAfterTheLastOneHasNoBit5) {
  SetPointHandshake handshake;
  handshake.begin(SetPointTiming::after_the_last);

  EXPECT_EQ(handshake.step(free_buffer), 0x0010);
  EXPECT_FALSE(handshake.taken());
  EXPECT_EQ(handshake.step(acknowledged), 0x0000);
  EXPECT_TRUE(handshake.taken());
  handshake.begin();
  EXPECT_FALSE(handshake.taken()) << "bit 12 is of the set-point before";
  EXPECT_EQ(handshake.step(acknowledged), 0x0000);
  EXPECT_EQ(handshake.step(free_buffer), 0x0030);
}

TEST(SetPointHandshake, WaitsUntilTheDriveHasRoom) {
  SetPointHandshake handshake;
  handshake.begin();

  EXPECT_EQ(handshake.step(acknowledged), 0x0020);
  EXPECT_EQ(handshake.step(free_buffer), 0x0030);
}

TEST(SetPointHandshake, RepeatsForATargetThatCameMeanwhile) {
  SetPointHandshake handshake;
  handshake.begin();
  handshake.step(free_buffer);
  handshake.begin();
  handshake.step(acknowledged);

  EXPECT_EQ(handshake.step(free_buffer), 0x0030);
  EXPECT_FALSE(handshake.done());
}

TEST(SetPointHandshake, RaisesNothingUnasked) {
  SetPointHandshake handshake;
  EXPECT_EQ(handshake.step(free_buffer), 0x0020);
  EXPECT_TRUE(handshake.done());
}

}  // namespace
}  // namespace takt
