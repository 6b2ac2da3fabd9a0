#include "master/motion/beat/homing_watch.hpp"

#include <gtest/gtest.h>

namespace takt::motion {
namespace {

constexpr std::uint16_t enabled = 0x0237;
constexpr std::uint16_t at_rest = 0x0637;
constexpr std::uint16_t homed = 0x1637;
constexpr std::uint16_t homed_and_moving = 0x1237;
constexpr std::uint16_t error = 0x2237;

struct Watched {
  HomingState run(std::uint16_t statusword) {
    return watch.step({.heard = true, .fresh = true, .homing = true, .statusword = statusword});
  }
  HomingState idle(std::uint16_t statusword = enabled) {
    return watch.step({.heard = true, .fresh = true, .homing = false, .statusword = statusword});
  }
  HomingWatch watch{10};
};

TEST(HomingWatch, ARunThatEndsWellHomesTheAxis) {
  Watched axis;
  EXPECT_EQ(axis.idle(homed), HomingState::none) << "in other modes these bits say something else";
  EXPECT_EQ(axis.run(at_rest), HomingState::runs) << "not begun yet";
  EXPECT_EQ(axis.run(enabled), HomingState::runs);
  EXPECT_EQ(axis.run(homed_and_moving), HomingState::runs);
  EXPECT_EQ(axis.run(homed), HomingState::homed);
  EXPECT_EQ(axis.idle(), HomingState::homed);
}

TEST(HomingWatch, AnErrorEndsItBadly) {
  Watched axis;
  axis.run(enabled);
  EXPECT_EQ(axis.run(error), HomingState::failed);
  EXPECT_EQ(axis.run(0x3637), HomingState::failed) << "both bits";
  EXPECT_EQ(axis.idle(), HomingState::failed);
}

TEST(HomingWatch, ARunThatIsEndedEarlyHomesNothing) {
  Watched axis;
  axis.run(enabled);
  EXPECT_EQ(axis.run(homed), HomingState::homed);
  axis.idle();
  axis.run(enabled);
  EXPECT_EQ(axis.idle(), HomingState::none) << "the first home position is lost, too";
}

TEST(HomingWatch, TheResultOfAnEarlierRunDoesNotCount) {
  Watched axis;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(axis.run(homed), HomingState::runs) << i;
  EXPECT_EQ(axis.run(enabled), HomingState::runs);
  EXPECT_EQ(axis.run(homed), HomingState::homed);
  axis.idle();
  EXPECT_EQ(axis.run(error), HomingState::runs) << "the error may be older";
  EXPECT_EQ(axis.run(homed), HomingState::homed) << "it has changed, so it is that of this run";
}

TEST(HomingWatch, AResultThatStaysIsThatOfTheRun) {
  Watched axis;
  for (int i = 0; i < 10; ++i) axis.run(homed);
  EXPECT_EQ(axis.run(homed), HomingState::homed) << "the drive had no way to go";
}

TEST(HomingWatch, AMissingStatuswordChangesNothing) {
  Watched axis;
  axis.run(enabled);
  EXPECT_EQ(axis.watch.step({.heard = true, .fresh = false, .homing = true, .statusword = homed}),
            HomingState::runs);
}

TEST(HomingWatch, ANodeThatIsNotHeardHasLostItsHome) {
  Watched axis;
  axis.run(enabled);
  axis.run(homed);
  EXPECT_EQ(axis.watch.step({.heard = false, .fresh = true, .homing = true, .statusword = homed}),
            HomingState::none);
  EXPECT_EQ(axis.idle(), HomingState::none);
}

}  // namespace
}  // namespace takt::motion
