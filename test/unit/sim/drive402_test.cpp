#include "master/sim/drive402.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "master/sim/emcy_producer.hpp"
#include "master/sim/object_store.hpp"
#include "test/unit/sim/sample_drive.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

class Drive : public testing::Test {
 protected:
  Drive() : store_{drive(5_node).build()}, emcy_{store_, 5_node}, drive_{store_, emcy_, Random{7}} {
    drive_.reset(0ns);
    run(20ms);
  }

  void set(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) {
    store_.find({index, sub})->set(static_cast<std::uint64_t>(value));
  }
  std::int64_t get(std::uint16_t index) { return store_.number({index, 0}); }
  void command(std::uint16_t word) {
    set(0x6040, word);
    drive_.outputs(now_);
  }
  void run(Time span) {
    for (const Time end = now_ + span; now_ < end;) {
      now_ += 1ms;
      drive_.advance(now_);
    }
  }
  void sync(std::int64_t target) {
    now_ += 2ms;
    drive_.advance(now_);
    set(0x607A, target);
    drive_.outputs(now_);
    drive_.on_sync(now_);
  }
  void enable(int mode) {
    set(0x6060, mode);
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
      command(word);
      run(1ms);
    }
  }
  /// Statusword without the bits of the mode.
  std::int64_t state() { return get(0x6041) & 0x27F; }

  ObjectStore store_;
  EmcyProducer emcy_;
  Drive402 drive_;
  Time now_{};
};

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

TEST_F(Drive, MovesToATargetWithTheHandshake) {
  enable(1);
  set(0x607A, 5000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0);

  command(0x001F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1400, 0x0000);

  run(300ms);
  EXPECT_GT(get(0x6064), 1000);
  EXPECT_LE(std::abs(get(0x606C)), 10'050);
  EXPECT_EQ(get(0x6041) & 0x0400, 0);

  run(700ms);
  EXPECT_EQ(get(0x6064), 5000);
  EXPECT_EQ(get(0x606C), 0);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);
}

// 5000 units at 10,000/s with ramps of 100,000/s2: 0.1 + 0.4 + 0.1 s
TEST_F(Drive, NeedsTheTimeOfItsTrapezoid) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);

  run(560ms);
  EXPECT_EQ(get(0x6041) & 0x0400, 0);
  run(160ms);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);
}

TEST_F(Drive, KeepsASecondSetPointUntilTheFirstIsReached) {
  enable(1);
  set(0x607A, 1000);
  command(0x001F);
  command(0x000F);
  set(0x607A, -1000);
  command(0x001F);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000) << "the buffer is full";

  run(150ms);
  EXPECT_GT(get(0x6064), 500);
  run(800ms);
  EXPECT_EQ(get(0x6064), -1000);
  EXPECT_EQ(get(0x6041) & 0x1000, 0);
}

TEST_F(Drive, ChangesTheTargetAtOnceWithBit5) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(100ms);
  command(0x000F);
  set(0x607A, -500);
  command(0x003F);
  command(0x000F);

  run(1500ms);
  EXPECT_EQ(get(0x6064), -500);
}

TEST_F(Drive, MovesRelativeToTheLastTarget) {
  enable(1);
  set(0x607A, 700);
  command(0x005F);
  command(0x000F);
  run(1s);
  command(0x005F);
  run(1s);

  EXPECT_EQ(get(0x6064), 1400);
}

TEST_F(Drive, HaltsAndGoesOn) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(200ms);
  command(0x011F);
  run(300ms);
  const std::int64_t halted = get(0x6064);
  EXPECT_LT(halted, 4000);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);

  run(100ms);
  EXPECT_EQ(get(0x6064), halted);
  command(0x001F);
  run(1s);
  EXPECT_EQ(get(0x6064), 5000);
}

TEST_F(Drive, StaysWithinItsSoftwareLimits) {
  set(0x607D, -300, 1);
  set(0x607D, 300, 2);
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(1s);

  EXPECT_EQ(get(0x6064), 300);
  EXPECT_EQ(get(0x6041) & 0x0800, 0x0800);
}

TEST_F(Drive, ReachesItsTargetVelocity) {
  enable(3);
  set(0x60FF, 8000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000) << "still stands";

  run(40ms);
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 4000, 300);
  run(100ms);
  EXPECT_EQ(get(0x606C), 8000);
  EXPECT_EQ(get(0x6041) & 0x1400, 0x0400);
}

TEST_F(Drive, FollowsCyclicPositions) {
  set(0x6065, 200);
  enable(8);
  double worst = 0;
  std::int64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto target = static_cast<std::int64_t>(20'000 * (1 - std::cos(i * 0.006)));
    sync(target);
    worst = std::max(worst, std::abs(static_cast<double>(get(0x60F4))));
    last = target;
  }
  EXPECT_LT(worst, 30);
  EXPECT_EQ(get(0x6041) & 0x3FFF, 0x1237);
  sync(last);
  for (int i = 0; i < 100; ++i) sync(last);
  EXPECT_EQ(get(0x6064), last);
}

TEST_F(Drive, TellsTorqueOfTheSignOfItsAcceleration) {
  enable(9);
  set(0x60FF, 100'000);
  run(1ms);
  EXPECT_GT(get(0x6077), 100);

  run(50ms);
  const std::int64_t friction = get(0x6077);
  EXPECT_GT(friction, 0);
  EXPECT_LT(friction, 50);

  set(0x60FF, 0);
  run(1ms);
  EXPECT_LT(get(0x6077), -100);
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

TEST_F(Drive, HomesWhereItStandsWithMethod35) {
  set(0x607C, 250);
  enable(6);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x0400);

  command(0x001F);
  run(5ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x1400);
  EXPECT_EQ(get(0x6064), -250);
}

TEST_F(Drive, HomesAtASwitchAhead) {
  set(0x6098, 17);
  enable(6);
  command(0x001F);
  run(100ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x0000);
  EXPECT_LT(get(0x606C), -4000);

  run(5s);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x1400);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), 0, 10);
}

TEST_F(Drive, ReportsAHomingMethodThatItDoesNotKnow) {
  set(0x6098, 36);
  enable(6);
  command(0x001F);
  run(5ms);

  EXPECT_EQ(get(0x6041) & 0x3400, 0x2400);
}

TEST_F(Drive, StopsHomingWhenBit4Falls) {
  set(0x6098, 18);
  enable(6);
  command(0x001F);
  run(100ms);
  command(0x000F);
  run(200ms);

  EXPECT_EQ(get(0x6041) & 0x3400, 0x0400);
  EXPECT_EQ(get(0x606C), 0);
}

TEST_F(Drive, SleepsOnlyWhileItStandsWithoutPower) {
  EXPECT_EQ(drive_.next_change(), never);
  enable(8);
  EXPECT_LT(drive_.next_change(), never);
}

}  // namespace
}  // namespace takt::sim
