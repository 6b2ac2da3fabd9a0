#include "master/core/network/axis_memory.hpp"

#include <gtest/gtest.h>
#include <optional>

namespace takt {
namespace {

constexpr std::int64_t switch_on_disabled = 0x0250;
constexpr std::int64_t ready_to_switch_on = 0x0231;
constexpr std::int64_t operation_enabled = 0x0237;
constexpr std::int64_t enable_operation = 0x000F;
constexpr std::int64_t shutdown = 0x0006;

void look(AxisMemory& axis, std::optional<std::int64_t> statusword,
          std::optional<std::int64_t> controlword, int cycles = 10) {
  for (int i = 0; i < cycles; ++i) axis.look(statusword, controlword);
}

TEST(AxisMemory, KnowsNothingAtTheBeginning) { EXPECT_FALSE(AxisMemory{}.disabled()); }

TEST(AxisMemory, RemembersAnAxisThatNeverWasEnabledWhenItIsGone) {
  AxisMemory axis;
  look(axis, switch_on_disabled, std::nullopt);
  look(axis, ready_to_switch_on, shutdown);
  look(axis, std::nullopt, std::nullopt);
  EXPECT_TRUE(axis.disabled());
}

TEST(AxisMemory, DoesNotCallAnAxisDisabledThatWasEnabledWhenItWasHeardLast) {
  AxisMemory axis;
  look(axis, operation_enabled, enable_operation);
  look(axis, std::nullopt, 0x0000);
  EXPECT_FALSE(axis.disabled());
}

TEST(AxisMemory, DoesNotTrustAStatuswordFromBeforeAnEnablingCommand) {
  AxisMemory axis;
  look(axis, ready_to_switch_on, shutdown);
  axis.look(ready_to_switch_on, enable_operation);
  EXPECT_FALSE(axis.disabled());
  look(axis, std::nullopt, shutdown);
  EXPECT_FALSE(axis.disabled()) << "silent since";
}

TEST(AxisMemory, DoesNotTrustAStatuswordRightBehindAnEnablingCommand) {
  AxisMemory axis;
  look(axis, ready_to_switch_on, enable_operation, 1);
  look(axis, ready_to_switch_on, 0x0000, 2);
  EXPECT_FALSE(axis.disabled());
  look(axis, switch_on_disabled, 0x0000, 1);
  EXPECT_TRUE(axis.disabled());
}

TEST(AxisMemory, RemembersAnAxisThatWasDisabledAgain) {
  AxisMemory axis;
  look(axis, operation_enabled, enable_operation);
  look(axis, operation_enabled, 0x0002);
  look(axis, switch_on_disabled, 0x0000, 1);
  EXPECT_TRUE(axis.disabled());
}

TEST(AxisMemory, WaitsForTheAnswerToAnEnablingWordOfAService) {
  AxisMemory axis;
  look(axis, switch_on_disabled, std::nullopt);
  axis.write(enable_operation);
  look(axis, switch_on_disabled, std::nullopt, 1000);
  EXPECT_FALSE(axis.disabled()) << "the word may reach the drive at any time";
  axis.write(0x0000);
  look(axis, switch_on_disabled, std::nullopt, 1000);
  EXPECT_FALSE(axis.disabled()) << "nor has the other word reached it";
  axis.confirm();
  EXPECT_FALSE(axis.disabled());
}

TEST(AxisMemory, TrustsAnAxisAgainThatIgnoresAnEnablingWordForLong) {
  AxisMemory axis;
  axis.write(enable_operation);
  axis.note_answer();
  look(axis, switch_on_disabled, std::nullopt, 99);
  EXPECT_FALSE(axis.disabled()) << "the drive may be slow";
  look(axis, switch_on_disabled, std::nullopt, 1);
  EXPECT_TRUE(axis.disabled());
  look(axis, std::nullopt, std::nullopt);
  EXPECT_TRUE(axis.disabled()) << "it is silent since";
}

TEST(AxisMemory, DoesNotTrustReadyToSwitchOnWhileAnEnablingWordMayStand) {
  AxisMemory axis;
  axis.write(enable_operation);
  axis.note_answer();
  look(axis, ready_to_switch_on, std::nullopt, 1000);
  EXPECT_FALSE(axis.disabled()) << "the word may act as soon as the drive is free to";
  look(axis, switch_on_disabled, std::nullopt, 1);
  look(axis, ready_to_switch_on, shutdown, 1);
  EXPECT_TRUE(axis.disabled()) << "the word has had no effect in between";
}

TEST(AxisMemory, IsConfirmedByAStop) {
  AxisMemory axis;
  axis.write(enable_operation);
  axis.note_answer();
  look(axis, std::nullopt, 0x0000, 2);
  axis.confirm();
  EXPECT_FALSE(axis.disabled()) << "the enabling word is too young";
  look(axis, std::nullopt, 0x0000, 1);
  axis.confirm();
  EXPECT_TRUE(axis.disabled());
}

TEST(AxisMemory, IsConfirmedByAStopOnlyUntilTheNextEnablingWord) {
  AxisMemory axis;
  axis.write(enable_operation);
  axis.note_answer();
  look(axis, switch_on_disabled, 0x0000);
  axis.confirm();
  axis.write(enable_operation);
  axis.note_answer();
  look(axis, std::nullopt, 0x0000, 1000);
  EXPECT_FALSE(axis.disabled());
}

TEST(AxisMemory, TakesStatuswordsBySdo) {
  AxisMemory axis;
  look(axis, std::nullopt, std::nullopt);
  axis.see(switch_on_disabled);
  EXPECT_TRUE(axis.disabled());
  axis.see(operation_enabled);
  EXPECT_FALSE(axis.disabled());
}

TEST(AxisMemory, HearsEachFrameOnce) {
  AxisMemory axis;
  EXPECT_TRUE(axis.has_new_frames(1));
  EXPECT_FALSE(axis.has_new_frames(1));
  EXPECT_TRUE(axis.has_new_frames(2));
}

}  // namespace
}  // namespace takt
