#include <gtest/gtest.h>
#include <takt/drive402.hpp>

namespace takt {
namespace {

constexpr std::uint16_t switch_on_disabled = 0x0250;
constexpr std::uint16_t ready = 0x0231;
constexpr std::uint16_t switched_on = 0x0233;
constexpr std::uint16_t enabled = 0x0237;
constexpr std::uint16_t quick_stop_active = 0x0217;
constexpr std::uint16_t fault_reaction = 0x021F;
constexpr std::uint16_t fault = 0x0218;

DriveSequence enabled_drive() {
  DriveSequence drive{{.reset_low_steps = 2, .hop_steps = 20}};
  drive.set_goal(DriveGoal::enabled);
  drive.step(enabled);
  return drive;
}

TEST(DriveSequence, EnablesOneHopAtATime) {
  DriveSequence drive;
  drive.set_goal(DriveGoal::enabled);

  EXPECT_EQ(drive.step(switch_on_disabled), 0x0006);
  EXPECT_EQ(drive.step(ready), 0x0007);
  EXPECT_EQ(drive.step(switched_on), 0x000F);
  EXPECT_FALSE(drive.reached());
  EXPECT_EQ(drive.step(enabled), 0x000F);
  EXPECT_TRUE(drive.reached());
}

TEST(DriveSequence, HoldsEachWordUntilTheStatuswordAcknowledges) {
  DriveSequence drive;
  drive.set_goal(DriveGoal::enabled);

  for (int i = 0; i < 50; ++i) EXPECT_EQ(drive.step(ready), 0x0007);
}

TEST(DriveSequence, IsNotEnabledWhileItWaitsButStaysEnabled) {
  DriveSequence drive;
  drive.set_goal(DriveGoal::enabled);

  EXPECT_EQ(drive.step(switch_on_disabled, Enabling::waits), 0x0000);
  EXPECT_EQ(drive.step(ready, Enabling::waits), 0x0000);
  EXPECT_EQ(drive.step(switched_on, Enabling::waits), 0x0006);
  EXPECT_EQ(drive.step(enabled, Enabling::waits), 0x000F);
  EXPECT_EQ(drive.goal(), DriveGoal::enabled);
}

TEST(DriveSequence, DisablesInOrder) {
  DriveSequence drive = enabled_drive();
  drive.set_goal(DriveGoal::disabled);

  EXPECT_EQ(drive.step(enabled), 0x0007);
  EXPECT_EQ(drive.step(switched_on), 0x0006);
  EXPECT_EQ(drive.step(ready), 0x0000);
  EXPECT_FALSE(drive.reached());
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0000);
  EXPECT_TRUE(drive.reached());
}

TEST(DriveSequence, StaysInQuickStopWhereTheDriveDoes) {
  DriveSequence drive = enabled_drive();
  drive.set_goal(DriveGoal::quick_stopped);

  EXPECT_EQ(drive.step(enabled), 0x0002);
  EXPECT_EQ(drive.step(quick_stop_active), 0x0002);
  EXPECT_TRUE(drive.reached());
}

TEST(DriveSequence, GivesTheFaultResetAnEdgeAndHoldsItUntilTheFaultIsGone) {
  DriveSequence drive{{.reset_low_steps = 2, .hop_steps = 20}};
  drive.step(fault);
  drive.reset_fault();

  EXPECT_EQ(drive.step(fault), 0x0000);
  EXPECT_EQ(drive.step(fault), 0x0000);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(drive.step(fault), 0x0080);
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0000);
}

TEST(DriveSequence, WaitsForTheFaultReactionBeforeItResets) {
  DriveSequence drive{{.reset_low_steps = 1, .hop_steps = 20}};
  drive.step(fault_reaction);
  drive.reset_fault();

  for (int i = 0; i < 5; ++i) EXPECT_EQ(drive.step(fault_reaction), 0x0000);
  EXPECT_EQ(drive.step(fault), 0x0000);
  EXPECT_EQ(drive.step(fault), 0x0080);
}

TEST(DriveSequence, GivesUpAResetWhoseCausePersists) {
  DriveSequence drive{{.reset_low_steps = 1, .hop_steps = 5}};
  drive.step(fault);
  drive.reset_fault();
  for (int i = 0; i < 6; ++i) drive.step(fault);

  EXPECT_EQ(drive.step(fault), 0x0000);
  EXPECT_EQ(drive.state(), State402::fault);
}

TEST(DriveSequence, EnablesAfterAResetWhereBothWereAsked) {
  DriveSequence drive{{.reset_low_steps = 1, .hop_steps = 20}};
  drive.step(fault);
  drive.reset_fault();
  drive.set_goal(DriveGoal::enabled);

  drive.step(fault);
  EXPECT_EQ(drive.step(fault), 0x0080);
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0006);
}

TEST(DriveSequence, IsNotEnabledAgainAfterAFaultUntilReported) {
  DriveSequence drive = enabled_drive();

  EXPECT_EQ(drive.step(fault_reaction), 0x0000);
  EXPECT_EQ(drive.goal(), DriveGoal::disabled);
  drive.step(fault);
  drive.reset_fault();
  for (int i = 0; i < 4; ++i) drive.step(fault);
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0000);
}

TEST(DriveSequence, IsNotEnabledAgainAfterSafeTorqueOffUntilReported) {
  DriveSequence drive = enabled_drive();

  EXPECT_EQ(drive.step(switch_on_disabled), 0x0000);
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0000);
  drive.set_goal(DriveGoal::enabled);
  EXPECT_EQ(drive.step(switch_on_disabled), 0x0006);
}

TEST(DriveSequence, KeepsTheLastStateWhenAStatuswordReportsNone) {
  DriveSequence drive = enabled_drive();

  EXPECT_EQ(drive.step(0x0201), 0x000F);
  EXPECT_TRUE(drive.unknown_statusword());
  EXPECT_EQ(drive.state(), State402::operation_enabled);
}

TEST(DriveSequence, IsStuckWhenADriveDoesNotFollow) {
  DriveSequence drive{{.reset_low_steps = 1, .hop_steps = 20}};
  drive.set_goal(DriveGoal::enabled);

  for (int i = 0; i < 20; ++i) drive.step(ready);
  EXPECT_FALSE(drive.stuck());
  drive.step(ready);
  drive.step(ready);
  EXPECT_TRUE(drive.stuck());
  drive.step(switched_on);
  EXPECT_FALSE(drive.stuck());
}

}  // namespace
}  // namespace takt
