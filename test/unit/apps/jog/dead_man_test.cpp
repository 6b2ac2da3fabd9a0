#include "apps/jog/dead_man.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;

class HeldKey : public ::testing::Test {
 protected:
  DeadMan dead_man_{{.first = 700ms, .next = 250ms}};
};

TEST_F(HeldKey, MovesFromThePressThroughTheDelayOfTheTerminal) {
  EXPECT_EQ(dead_man_.direction(0ms), 0);
  dead_man_.press(1, 1000ms);
  EXPECT_EQ(dead_man_.direction(1000ms), 1);
  EXPECT_EQ(dead_man_.direction(1660ms), 1) << "the first repetition comes late";
  EXPECT_EQ(dead_man_.direction(1701ms), 0);
}

TEST_F(HeldKey, StopsSoonAfterTheLastRepetition) {
  dead_man_.press(-1, 1000ms);
  for (Time now = 1660ms; now < 5000ms; now += 40ms) {
    EXPECT_EQ(dead_man_.direction(now), -1);
    dead_man_.press(-1, now);
  }
  EXPECT_EQ(dead_man_.direction(5220ms), -1);
  EXPECT_EQ(dead_man_.direction(5251ms), 0);
  EXPECT_EQ(dead_man_.direction(5252ms), 0);
}

TEST_F(HeldKey, BeginsAgainWithThePressOfTheOtherDirection) {
  dead_man_.press(1, 1000ms);
  dead_man_.press(1, 1500ms);
  dead_man_.press(-1, 1540ms);
  EXPECT_EQ(dead_man_.direction(1540ms), -1);
  EXPECT_EQ(dead_man_.direction(2240ms), -1) << "the delay of the terminal counts from here";
}

TEST_F(HeldKey, StopsWithEachOtherKey) {
  dead_man_.press(1, 1000ms);
  dead_man_.release();
  EXPECT_EQ(dead_man_.direction(1000ms), 0);
}

}  // namespace
}  // namespace takt
