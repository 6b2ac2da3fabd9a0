#include "apps/takt/soak/judge/limit_judge.hpp"

#include <gtest/gtest.h>
#include <memory>

#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr SignalIndex controlword = 4;
constexpr SignalIndex target = 6;  // 607A of the first axis, unless a test changes the object

/// One limited output of an axis at 2 ms. The axis follows, unless a test says otherwise.
class LimitJudges : public testing::Test {
 protected:
  LimitJudges() {
    limit.signal = target;
    limit.quantity = AxisQuantity::position;
  }

  /// Starts with the axis at 1000 and sends the first set-point.
  void begin() {
    plan.limits.outputs = {limit};
    judge = std::make_unique<LimitJudge>(plan, world, verdict);
    cycle();
    hear(0x37, 1000);
    give(target, 1000, true);
    give(controlword, 0x000F, false);
    pass(20);
    EXPECT_TRUE(verdict.good());
  }
  void hear(std::uint8_t statusword, std::uint16_t position) {
    judge->heard(make_frame(CobId::base(0x181),
                            {statusword, 0x02, static_cast<std::uint8_t>(position & 0xFF),
                             static_cast<std::uint8_t>(position >> 8), 0x00, 0x00}));
  }
  void cycle() { judge->begin_cycle(now += 2ms); }
  void give(SignalIndex signal, std::uint64_t bits, bool begins) {
    judge->sent(signal, bits, begins);
    judge->judge(now);
  }
  /// Sends the frame with the last value in each cycle.
  void pass(unsigned cycles) {
    for (; cycles != 0; --cycles) send({last});
  }
  void send(std::initializer_list<std::int64_t> values) {
    for (const std::int64_t value : values) {
      cycle();
      give(target, static_cast<std::uint64_t>(value), false);
      last = value;
    }
  }
  bool blames(const char* kind) const {
    if (verdict.good()) return false;
    EXPECT_EQ(verdict.violation()->invariant, "no output leaves its limits");
    return verdict.violation()->what.find(std::string{"the limit of "} + kind + ":") !=
           std::string::npos;
  }
  void follow_actual() {
    limit.feedback = 2;
    limit.statusword = 0;
  }
  void be(std::uint16_t index, DataType type, std::uint8_t bits) {
    Signal& signal = plan.layout.signals[target];
    signal.object = {index, 0};
    signal.type = type;
    signal.bits = bits;
    limit.quantity = index == 0x60FF ? AxisQuantity::velocity : AxisQuantity::torque;
    if (index == 0x607A) limit.quantity = AxisQuantity::position;
  }

  BusPlan plan = test::axes();
  OutputLimit limit;
  Verdict verdict;
  sim::World world{{}, {}};
  std::unique_ptr<LimitJudge> judge;
  Time now = 1s;
  std::int64_t last = 1000;
};

TEST_F(LimitJudges, BlameAPositionOutsideTheRange) {
  limit.low = -2000;
  limit.high = 2000;
  limit.range = LimitKind::position;
  begin();
  send({2000, -2000});
  EXPECT_TRUE(verdict.good());

  send({-2001});

  EXPECT_TRUE(blames("position"));
}

TEST_F(LimitJudges, BlameAStep) {
  limit.step = 10.5;
  begin();
  send({1010, 1021, 1011});
  EXPECT_TRUE(verdict.good());

  send({1023});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, CountAStepOverTheCyclesThatHavePassed) {
  limit.step = 10;
  begin();
  pass(2);
  send({1030});
  EXPECT_TRUE(verdict.good());

  pass(1);
  send({1051});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, CountNoSilenceLongerThanFiftyMilliseconds) {
  limit.step = 10;
  begin();
  pass(100);
  send({1250});
  EXPECT_TRUE(verdict.good());

  pass(100);
  send({1501});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, BlameAVelocityOfPositions) {
  limit.rate = 10;
  limit.rate_of = LimitKind::velocity;
  begin();
  send({1010});
  EXPECT_TRUE(verdict.good());

  send({1021});

  EXPECT_TRUE(blames("velocity"));
}

TEST_F(LimitJudges, BlameAnAccelerationOfPositions) {
  limit.bend = 5;
  begin();
  send({1001, 1007, 1018, 1034});
  EXPECT_TRUE(verdict.good());

  send({1042});  // a step of 8 counts after one of 16

  EXPECT_TRUE(blames("acceleration"));
}

TEST_F(LimitJudges, TakeARestAfterWhichAPositionStartsAnew) {
  limit.bend = 5;
  begin();
  send({1006, 1012, 1012, 1012, 1017});
  EXPECT_TRUE(verdict.good());
}

TEST_F(LimitJudges, BlameAnAccelerationOverACycleThatWasLeftOut) {
  limit.bend = 5;
  begin();
  send({1006, 1012});
  cycle();
  send({1080});
  EXPECT_TRUE(blames("acceleration"));
}

TEST_F(LimitJudges, TakeTheShortWayWhereAnAxisTurnsOver) {
  limit.step = 10;
  limit.modulus = 1008;
  begin();
  send({1007, 3, 1001});
  EXPECT_TRUE(verdict.good());

  send({2009});  // a whole turn

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, TakeAWayOverTheEndOfTheObject) {
  limit.step = 10;
  limit.wraps = true;
  be(0x607A, DataType::integer32, 32);
  plan.limits.outputs = {limit};
  judge = std::make_unique<LimitJudge>(plan, world, verdict);
  give(target, last = 0x7FFF'FFFF, true);
  pass(20);
  send({0x8000'0001});
  EXPECT_TRUE(verdict.good());

  send({0x7FFF'FFF0});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, BlameATargetVelocityAndItsAcceleration) {
  be(0x60FF, DataType::integer32, 32);
  limit.low = -2000;
  limit.high = 2000;
  limit.range = LimitKind::velocity;
  limit.rate = 100;
  limit.rate_of = LimitKind::acceleration;
  begin();
  send({1100, 1000});
  EXPECT_TRUE(verdict.good());

  send({1101});

  EXPECT_TRUE(blames("acceleration"));
}

TEST_F(LimitJudges, BlameATargetVelocityOutsideItsLimit) {
  be(0x60FF, DataType::integer32, 32);
  limit.low = -2000;
  limit.high = 2000;
  limit.range = LimitKind::velocity;
  begin();

  send({-2001});

  EXPECT_TRUE(blames("velocity"));
}

TEST_F(LimitJudges, BlameATorqueAsTheDeviceReadsIt) {
  be(0x6071, DataType::integer16, 16);
  limit.low = -1000;
  limit.high = 1000;
  limit.range = LimitKind::torque;
  begin();
  send({0xFC18});  // -1000
  EXPECT_TRUE(verdict.good());

  send({0xFC17});

  EXPECT_TRUE(blames("torque"));
}

TEST_F(LimitJudges, TakeTheFallbackOfATorque) {
  be(0x6071, DataType::integer16, 16);
  plan.layout.signals[target].fallback = Fallback::value;
  limit.low = 500;
  limit.high = 1000;
  limit.rate = 10;
  begin();

  send({0});

  EXPECT_TRUE(verdict.good());
}

TEST_F(LimitJudges, TakeAFirstPositionWhereTheAxisIsAndNoOther) {
  follow_actual();
  limit.step = 10;
  begin();
  judge->begin_anew();
  hear(0x40, 9000);
  send({9000});
  EXPECT_TRUE(verdict.good());

  judge->begin_anew();
  send({9100});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, LetAnAxisThatDoesNotFollowGoOnFromWhereItIs) {
  follow_actual();
  limit.step = 10;
  begin();
  hear(0x40, 5000);
  send({5010});
  EXPECT_TRUE(verdict.good());

  hear(0x37, 7000);
  pass(20);
  send({7000});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, ReadTheStateOfAnAxisFromItsControlwordToo) {
  follow_actual();
  limit.step = 10;
  begin();
  hear(0x37, 5000);
  give(controlword, 0x0002, false);
  send({5010});
  EXPECT_TRUE(verdict.good());

  give(controlword, 0x000F, false);
  pass(8);
  send({5201});

  EXPECT_TRUE(blames("step"));
}

TEST_F(LimitJudges, HoldProfilePositionsAgainstTheRangeOnly) {
  limit.fixed_mode = 1;  // profile position
  limit.step = 10;
  limit.low = -2000;
  limit.high = 2000;
  limit.range = LimitKind::position;
  begin();
  send({-2000, 2000});
  EXPECT_TRUE(verdict.good());

  send({2001});

  EXPECT_TRUE(blames("position"));
}

/// A target velocity and its offset, which are sent in one cycle.
class SumJudges : public LimitJudges {
 protected:
  SumJudges() {
    be(0x60FF, DataType::integer32, 32);
    plan.layout.signals[offset] = plan.layout.signals[target];
    plan.layout.signals[offset].object = {0x60B1, 0};
    limit.low = -2000;
    limit.high = 2000;
    limit.range = LimitKind::velocity;
    limit.offset = offset;
  }
  void send_both(std::int64_t first, std::int64_t second) {
    cycle();
    judge->sent(target, static_cast<std::uint64_t>(first), false);
    judge->sent(offset, static_cast<std::uint64_t>(second), false);
    judge->judge(now);
  }
  static constexpr SignalIndex offset = 7;
};

TEST_F(SumJudges, BlameASumOutsideTheRangeAndNoPartOfIt) {
  begin();
  send_both(3000, -1500);
  send_both(-1000, 3000);
  EXPECT_TRUE(verdict.good());

  send_both(1500, 501);

  EXPECT_TRUE(blames("velocity"));
}

TEST_F(SumJudges, BlameTheChangeOfASum) {
  limit.rate = 100;
  limit.rate_of = LimitKind::acceleration;
  begin();
  send_both(1500, -450);
  EXPECT_TRUE(verdict.good());

  send_both(1560, -405);

  EXPECT_TRUE(blames("acceleration"));
}

TEST_F(SumJudges, BlameTheTargetAloneInAModeThatAddsNoOffset) {
  limit.fixed_mode = 8;  // cyclic synchronous position
  begin();
  send_both(1500, 1500);
  EXPECT_TRUE(verdict.good());

  send_both(2001, 0);

  EXPECT_TRUE(blames("velocity"));
}

}  // namespace
}  // namespace takt::soak
