#include "master/sim/model/drive402.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "test/unit/master/sim/model/drive_fixture.hpp"

namespace takt::sim {
namespace {

TEST_F(Drive, IsNotReadyUntilInitialised) {
  drive_.reset(now_);
  EXPECT_EQ(get(0x6041), 0x0000);

  run(11ms);
  EXPECT_EQ(get(0x6041), 0x0250);
}

TEST_F(Drive, ComesUpStepByStep) {
  command(0x0006);
  EXPECT_EQ(get(0x6041), 0x0231);
  command(0x0007);
  EXPECT_EQ(get(0x6041), 0x0233);
  command(0x000F);
  EXPECT_EQ(get(0x6041), 0x0237);
}

TEST_F(Drive, IgnoresEnableOperationWithoutShutdownBefore) {
  command(0x000F);
  run(10ms);

  EXPECT_EQ(state(), 0x250);
}

TEST_F(Drive, TakesTransitions3And4OfOneWord) {
  command(0x0006);
  command(0x000F);
  run(2ms);

  EXPECT_EQ(get(0x6041), 0x0237);
}

struct Step {
  std::initializer_list<std::uint16_t> words;
  std::int64_t status;
  const char* transition;
};

TEST_F(Drive, GoesWhereEachCommandLeads) {
  const Step steps[] = {
      {{0x06, 0x00}, 0x250, "7: disable voltage"},
      {{0x06, 0x02}, 0x250, "7: quick stop"},
      {{0x06, 0x07, 0x06}, 0x231, "6"},
      {{0x06, 0x07, 0x00}, 0x250, "10: disable voltage"},
      {{0x06, 0x07, 0x02}, 0x250, "10: quick stop"},
      {{0x06, 0x07, 0x0F, 0x07}, 0x233, "5"},
      {{0x06, 0x07, 0x0F, 0x06}, 0x231, "8"},
      {{0x06, 0x07, 0x0F, 0x00}, 0x250, "9"},
      {{0x06, 0x07, 0x0F, 0x86}, 0x237, "bit 7 asks for nothing"},
      {{0x07}, 0x250, "switch on without shutdown"},
  };

  for (const Step& step : steps) {
    SCOPED_TRACE(step.transition);
    drive_.reset(now_);
    command(0);
    run(20ms);
    for (const std::uint16_t word : step.words) {
      command(word);
      run(3ms);
    }
    EXPECT_EQ(state(), step.status);
  }
}

TEST_F(Drive, FaultsWhenTheTargetJumpsAway) {
  set(0x6065, 200);
  enable(8);
  sync(0);
  sync(0);

  for (int i = 0; i < 20; ++i) sync(50'000'000);

  EXPECT_EQ(get(0x603F), 0x8611);
  EXPECT_TRUE(emcy_.is_active(0x8611, 1));
  run(2s);
  EXPECT_EQ(state(), 0x218);
}

TEST_F(Drive, ResetsAFaultOnlyByTheEdgeOfBit7) {
  command(0x0080);
  drive_.fail(0x3210, now_);
  run(5ms);
  EXPECT_EQ(state(), 0x218);
  command(0x0080);
  EXPECT_EQ(state(), 0x218) << "bit 7 was set before: no edge";

  command(0x0000);
  command(0x0080);
  run(1ms);
  EXPECT_EQ(state(), 0x250);
  EXPECT_FALSE(emcy_.is_active(0x3210, 1));
  EXPECT_EQ(get(0x603F), 0);
}

TEST_F(Drive, RampsDownBeforeItIsInFault) {
  enable(3);
  set(0x60FF, 8000);
  run(200ms);

  drive_.fail(0x3210, now_);
  EXPECT_EQ(state(), 0x21F);
  run(100ms);
  EXPECT_EQ(state(), 0x218);
  EXPECT_EQ(get(0x606C), 0);
}

TEST_F(Drive, LeavesQuickStopByItselfWithOption2) {
  enable(3);
  set(0x60FF, 8000);
  run(200ms);

  command(0x0002);
  EXPECT_EQ(state(), 0x217);
  run(100ms);
  EXPECT_EQ(state(), 0x250);
}

TEST_F(Drive, StaysInQuickStopWithOption6) {
  set(0x605A, 6);
  enable(3);
  set(0x60FF, 8000);
  run(200ms);

  command(0x0002);
  run(500ms);
  EXPECT_EQ(state(), 0x217);
  EXPECT_EQ(get(0x606C), 0);
  command(0x000F);
  run(300ms);
  EXPECT_EQ(state(), 0x237);
  EXPECT_EQ(get(0x606C), 8000);
}

TEST_F(Drive, FaultsWhenTheConnectionIsLostWhileEnabled) {
  drive_.connection_lost(now_);
  EXPECT_EQ(state(), 0x250) << "not enabled: nothing to stop";

  enable(8);
  drive_.connection_lost(now_);
  run(100ms);
  EXPECT_EQ(state(), 0x218);
}

TEST_F(Drive, RefusesAModeThatItDoesNotSupport) {
  const Object& mode = *store_.find({0x6060, 0});

  EXPECT_EQ(drive_.check_write(mode, 8), Abort::none);
  EXPECT_EQ(drive_.check_write(mode, 2), Abort::value);
  EXPECT_EQ(drive_.check_write(mode, 0xFF), Abort::value);
  set(0x6060, 2);
  drive_.outputs(now_);
  EXPECT_EQ(get(0x6061), 0);
}

TEST_F(Drive, SleepsOnlyWhileItStandsWithoutPower) {
  EXPECT_EQ(drive_.next_change(), never);
  enable(8);
  EXPECT_LT(drive_.next_change(), never);
}

}  // namespace
}  // namespace takt::sim
