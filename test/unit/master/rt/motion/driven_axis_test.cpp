#include "master/rt/motion/driven_axis.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using motion::AxisReport;
using motion::AxisState;

struct BenchOptions {
  bool commands_controlword = true;  ///< otherwise RPDO1 has an object without a value
  bool mode = false;                 ///< RPDO2 has the mode of operation (6060)
};

/// One axis with a velocity offset (60B1) in RPDO2. A count is 0.01 rad, and 0.1 rad/s.
BusPlan one_axis(bool mode = false) {
  BusPlan plan = test::axes({.nodes = 1, .fallback_cycles = 0});
  for (Signal& signal : plan.layout.signals) {
    if (signal.object.index != 0x6064 && signal.object.index != 0x607A) continue;
    signal.scale = 0.01;
    signal.unit = "rad";
  }
  Signal offset = test::make_signal(1_node, 0, {0x60B1, 0});
  offset.type = DataType::integer32;
  offset.bits = 32;
  offset.output = true;
  offset.row = 1;
  offset.scale = 0.1;
  offset.unit = "rad/s";
  plan.layout.signals.push_back(offset);
  test::add_pdo(plan, false, {.cob_id = CobId::base(0x301), .node = 1_node, .transmission = 1},
                {{.signal = 4, .bit_offset = 0, .bits = 32, .sign_extend = true}});
  if (!mode) return plan;
  Signal modes = test::make_signal(1_node, 0, {0x6060, 0});
  modes.type = DataType::integer8;
  modes.bits = 8;
  modes.output = true;
  modes.row = 2;
  plan.layout.signals.push_back(modes);
  test::add_pdo(plan, false, {.cob_id = CobId::base(0x401), .node = 1_node, .transmission = 1},
                {{.signal = 5, .bit_offset = 0, .bits = 8, .sign_extend = true}});
  return plan;
}

class Bench {
 public:
  explicit Bench(BenchOptions options = {})
      : plan{one_axis(options.mode)}, pdos{plan, events}, axis{motion_axes(plan).at(0), plan} {
    pdos.inputs().set_reception(0, Reception::full);
    pdos.outputs().open(0, points);
    if (options.commands_controlword) command(0, 0x000F);
    if (options.mode) command(3, 8);
    hear(0x0023, 0);
    pack();
  }
  void hear(std::uint16_t statusword, std::int32_t position) {
    ++cycle;
    pdos.inputs().begin(cycle, Time{cycle * 2'000'000});
    StampedFrame stamped{.frame = {}, .when = Time{cycle * 2'000'000 + 100'000}};
    stamped.frame.id = CobId::base(0x181);
    stamped.frame.length = 6;
    for (unsigned i = 0; i < 2; ++i) {
      stamped.frame.data[i] = static_cast<std::uint8_t>(statusword >> 8 * i);
    }
    for (unsigned i = 0; i < 4; ++i) {
      stamped.frame.data[2 + i] = static_cast<std::uint8_t>(position >> 8 * i);
    }
    ASSERT_TRUE(pdos.inputs().receive(stamped));
    pdos.inputs().close(stamped.when);
  }
  /// Sends the outputs of the cycle, or only packs them. Without a controlword, RPDO1 has a value
  /// that is not known.
  void pack(bool sends = true) {
    const OutputMoment moment{.cycle = cycle, .now = Time{cycle * 2'000'000}};
    const std::size_t count = pdos.outputs().pack(points, moment).size();
    pdos.outputs().sent(sends ? count : 0, moment);
  }
  void command(std::size_t output, std::int64_t value) {
    SetPoint& point = points[output];
    point = {
        .value = value, .generation = point.generation + 1, .when = Time{(cycle + 1) * 2'000'000}};
  }
  void hear_nothing() {
    ++cycle;
    pdos.inputs().begin(cycle, Time{cycle * 2'000'000});
    pdos.inputs().close(Time{cycle * 2'000'000 + 1'000'000});
  }
  AxisCondition condition(bool exchanging = true) {
    return axis.read(pdos, exchanging, last).condition;
  }
  bool write(AxisState state, motion::State commanded) {
    last.state = state;
    last.commanded = commanded;
    return axis.write(pdos.outputs(), last, {.cycle = cycle, .now = Time{cycle * 2'000'000}});
  }
  std::int64_t target() const { return pdos.image().values[3]; }
  std::int64_t offset() const { return pdos.image().values[4]; }

  BusPlan plan;
  EventQueue events;
  PdoExchange pdos;
  DrivenAxis axis;
  AxisReport last;
  std::vector<SetPoint> points = std::vector<SetPoint>(4);
  std::uint64_t cycle = 0;
};

TEST(DrivenAxis, ReadsTheConditionFromTheStatusword) {
  Bench bench;
  bench.hear(0x0027, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear(0x0023, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled);
  bench.hear(0x0007, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled) << "quick stop active";
  bench.hear(0x0008, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault);
  bench.hear(0x000F, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault) << "fault reaction active";
  EXPECT_EQ(bench.condition(false), AxisCondition::lost);
}

TEST(DrivenAxis, OneMissingFrameIsNoSilenceButThreeAre) {
  Bench bench;
  bench.hear(0x0027, 100);
  bench.last.commanded.position = 1.5;
  bench.last.following_error = 0.5;
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear_nothing();
  const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
  EXPECT_EQ(input.condition, AxisCondition::enabled);
  EXPECT_EQ(input.actual.position, 1.0) << "the following error counts as unchanged";
  bench.hear_nothing();
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear_nothing();
  EXPECT_EQ(bench.condition(), AxisCondition::silent);
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
}

TEST(DrivenAxis, AHaltIsNoLossOfOperationEnabled) {
  Bench bench;
  bench.command(0, 0x010F);
  bench.pack();
  bench.hear(0x0027, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::halted);
  bench.hear(0x0008, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault);
}

/// Bit 12 of the statusword is 1 while the drive follows its target position.
TEST(DrivenAxis, TheTargetFollowsTheActualPositionWhileADriveObeysAHalt) {
  Bench bench;
  const auto beat = [&](std::uint16_t statusword, std::int32_t position, AxisState state) {
    bench.hear(statusword, position);
    const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
    if (input.set_point) bench.last.commanded.position = *input.set_point;
    EXPECT_TRUE(bench.write(state, bench.last.commanded));
    bench.pack();
  };
  bench.hear(0x1027, 100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.pack();
  bench.command(0, 0x010F);
  beat(0x1027, 100, AxisState::standing);
  beat(0x1027, 90, AxisState::standing);
  EXPECT_EQ(bench.target(), 100) << "it follows its target in spite of the Halt";
  beat(0x0027, 80, AxisState::standing);
  EXPECT_EQ(bench.target(), 80);
  beat(0x0027, 75, AxisState::standing);
  EXPECT_EQ(bench.target(), 75);
  bench.command(0, 0x000F);
  beat(0x0027, 75, AxisState::standing);
  beat(0x1027, 74, AxisState::standing);
  EXPECT_EQ(bench.target(), 75);
}

/// A drive that nobody hears may still follow its target position.
TEST(DrivenAxis, TheTargetFollowsTheActualPositionOnlyWhileTheStatuswordSaysThatItHasNoEffect) {
  Bench bench;
  bench.hear(0x0027, 100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  const auto hold = [&](bool exchanging) {
    bench.condition(exchanging);
    bench.last.actual.position = 1.0;
    return bench.write(AxisState::unpowered, {.position = 1.0});
  };
  bench.hear(0x0027, 100);
  ASSERT_TRUE(hold(false));
  EXPECT_EQ(bench.target(), 120) << "the node is lost";
  bench.hear_nothing();
  ASSERT_TRUE(hold(true));
  EXPECT_EQ(bench.target(), 120) << "the statusword is missing";
  bench.hear(0x0023, 100);
  ASSERT_TRUE(hold(true));
  EXPECT_EQ(bench.target(), 100);
}

TEST(DrivenAxis, WritesPositionAndVelocityInCounts) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = -1.236, .velocity = 0.74}));
  EXPECT_EQ(bench.target(), -124);
  EXPECT_EQ(bench.offset(), 7);
  EXPECT_FALSE(bench.axis.read(bench.pdos, true, bench.last).set_point.has_value());
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = -1.25}));
  EXPECT_EQ(bench.target(), -125);
  EXPECT_EQ(bench.offset(), 0);
}

TEST(DrivenAxis, APositionThatInteger32CannotHoldIsNotWritten) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7}));
  EXPECT_EQ(bench.target(), 100);
}

/// The second set-point of the motion can't be written.
TEST(DrivenAxis, AfterARefusedSetPointTheVelocityIsZeroAndTheTargetFollowsADriveThatIsNotEnabled) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0, .velocity = 0.7}));
  ASSERT_EQ(bench.offset(), 7);
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7, .velocity = 0.7}));
  EXPECT_EQ(bench.target(), 100);
  EXPECT_EQ(bench.offset(), 0);
  bench.hear(0x0027, 90);
  const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
  ASSERT_TRUE(input.set_point.has_value());
  EXPECT_EQ(*input.set_point, 1.0) << "where the motion has led the axis";
  bench.hear(0x0023, 95);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.95}));
  EXPECT_EQ(bench.target(), 95);
}

TEST(DrivenAxis, AMotionWhoseFirstSetPointIsRefusedLeavesTheOutputsToOthers) {
  Bench bench;
  bench.hear(0x0023, 40);
  bench.command(1, 55);
  bench.command(2, 3);
  bench.pack();
  bench.condition();
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7, .velocity = 0.7}));
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.4}));
  EXPECT_EQ(bench.target(), 55);
  EXPECT_EQ(bench.offset(), 3);
}

TEST(DrivenAxis, TheTargetFollowsTheActualPositionWhileTheDriveIsNotEnabled) {
  Bench bench;
  bench.hear(0x0027, 100);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.hear(0x0008, 130);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 1.3}));
  EXPECT_EQ(bench.target(), 130);
}

TEST(DrivenAxis, ASetPointOfAnApplicationIsReadAndNotOverwritten) {
  Bench bench;
  bench.hear(0x0027, 0);
  bench.command(1, 55);
  bench.pack();
  const auto input = bench.axis.read(bench.pdos, true, bench.last);
  ASSERT_TRUE(input.set_point.has_value());
  EXPECT_DOUBLE_EQ(*input.set_point, 0.55);
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 0.55}));
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.0}));
  EXPECT_EQ(bench.target(), 55);
}

/// A position in one unit must not be written in another one.
TEST(DrivenAxis, AnAxisWhoseTargetHasAnotherUnitThanItsPositionHasNoMotions) {
  const auto axes_after = [](auto change) {
    BusPlan plan = one_axis();
    change(plan.layout.signals[3]);
    return motion_axes(plan).size();
  };
  EXPECT_EQ(axes_after([](Signal&) {}), 1U);
  EXPECT_EQ(axes_after([](Signal& target) { target.scale = 0.02; }), 0U);
  EXPECT_EQ(axes_after([](Signal& target) { target.offset = 1.0; }), 0U);
  EXPECT_EQ(axes_after([](Signal& target) { target.unit = "m"; }), 0U);
}

/// Modes 7, interpolated position, and 3, profile velocity.
TEST(DrivenAxis, TheTargetDoesNotFollowTheActualPositionInAModeInWhichTheDriveMayFollowIt) {
  Bench bench{{.commands_controlword = true, .mode = true}};
  bench.hear(0x0027, 100);
  ASSERT_EQ(bench.condition(), AxisCondition::enabled);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  const auto after_mode = [&](std::int64_t mode) {
    bench.command(3, mode);
    bench.pack();
    bench.hear(0x0027, 100);
    EXPECT_EQ(bench.condition(), AxisCondition::disabled) << mode;
    bench.last.actual.position = 1.0;
    EXPECT_TRUE(bench.write(AxisState::unpowered, {.position = 1.0}));
    return bench.target();
  };
  EXPECT_EQ(after_mode(7), 120);
  EXPECT_EQ(after_mode(-1), 120) << "a mode of the manufacturer";
  EXPECT_EQ(after_mode(3), 100);
}

/// Homing changes the coordinates of the drive, so that a target of an application from before it
/// is somewhere else.
TEST(DrivenAxis, InHomingModeTheTargetFollowsWhoeverHasCommandedIt) {
  Bench bench{{.commands_controlword = true, .mode = true}};
  bench.hear(0x0027, 0);
  bench.command(1, 55);
  bench.pack();
  bench.hear(0x0027, 55);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 0.55}));
  bench.command(3, 6);
  bench.pack();
  bench.hear(0x0027, 55);
  bench.condition();
  bench.last.actual.position = 9.0;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 9.0}));
  EXPECT_EQ(bench.target(), 900);
}

TEST(DrivenAxis, SeesAHomingRunOfTheEnabledDriveInHomingMode) {
  using motion::HomingState;
  Bench bench{{.commands_controlword = true, .mode = true}};
  const auto after = [&](std::int64_t controlword, std::int64_t mode, std::uint16_t statusword) {
    bench.command(0, controlword);
    bench.command(3, mode);
    bench.pack();
    bench.hear(statusword, 0);
    return bench.axis.read(bench.pdos, true, bench.last).homing;
  };
  EXPECT_EQ(after(0x1F, 8, 0x0027), HomingState::none) << "in another mode";
  EXPECT_EQ(after(0x0F, 6, 0x0027), HomingState::none) << "bit 4 is not set";
  EXPECT_EQ(after(0x1F, 6, 0x0023), HomingState::none) << "not enabled";
  EXPECT_EQ(after(0x1F, 6, 0x0027), HomingState::runs);
  EXPECT_EQ(after(0x1F, 6, 0x1427), HomingState::homed);
  EXPECT_EQ(after(0x0F, 8, 0x1027), HomingState::homed);
  EXPECT_EQ(bench.axis.read(bench.pdos, false, bench.last).homing, HomingState::none);
}

/// The node was away only while there was no SYNC, so that no beat has seen it away.
TEST(DrivenAxis, LosesItsHomeBetweenBeats) {
  using motion::HomingState;
  Bench bench{{.commands_controlword = true, .mode = true}};
  const auto homing = [&](std::uint16_t statusword) {
    bench.hear(statusword, 0);
    return bench.axis.read(bench.pdos, true, bench.last).homing;
  };
  bench.command(0, 0x1F);
  bench.command(3, 6);
  bench.pack();
  ASSERT_EQ(homing(0x0027), HomingState::runs);
  ASSERT_EQ(homing(0x1427), HomingState::homed);
  bench.command(0, 0x0F);
  bench.command(3, 8);
  bench.pack();
  ASSERT_EQ(homing(0x1027), HomingState::homed);
  bench.axis.lose_home();
  EXPECT_EQ(homing(0x1027), HomingState::none);
}

/// The application enables the drive by its controlword only, and the axis was pushed.
TEST(DrivenAxis, ATargetThatNobodyHasCommandedFollowsTheActualPositionWhileTheDriveIsNotEnabled) {
  Bench bench;
  bench.hear(0x0023, 1000);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 10.0}));
  EXPECT_EQ(bench.target(), 1000);
  bench.pack();
  bench.hear(0x0027, 1100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 10.0}));
  EXPECT_EQ(bench.target(), 1000) << "it is enabled";
}

/// The set-points of a motion would be held back, and then be sent as one step.
TEST(DrivenAxis, AnAxisWhoseRpdoIsNotReadyIsNotEnabled) {
  Bench bench{{.commands_controlword = false, .mode = false}};
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled);
  bench.command(0, 0x000F);
  bench.pack();
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
}

/// An event-driven RPDO whose set-points do not change sends nothing.
TEST(DrivenAxis, ATargetThatDoesNotChangeNeedsNoFrame) {
  Bench bench;
  bench.hear(0x0027, 0);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.pack();
  bench.hear(0x0027, 0);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 1.0}));
  bench.command(1, 120);
  bench.pack();
  for (int beat = 0; beat < 5; ++beat) {
    bench.hear(0x0027, 0);
    EXPECT_EQ(bench.condition(), AxisCondition::enabled) << beat;
    ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  }
}

TEST(DrivenAxis, ASetPointThatWasDueAndNotSentIsTold) {
  Bench bench;
  const auto is_unsent = [&](double position, bool sends) {
    bench.hear(0x0027, 0);
    const bool found = bench.axis.read(bench.pdos, true, bench.last).is_unsent;
    EXPECT_TRUE(bench.write(AxisState::moving, {.position = position}));
    bench.pack(sends);
    return found;
  };
  EXPECT_FALSE(is_unsent(0.1, true));
  EXPECT_FALSE(is_unsent(0.2, false));
  EXPECT_TRUE(is_unsent(0.2, true));
  EXPECT_FALSE(is_unsent(0.3, true));
}

TEST(DrivenAxis, OneSetPointMayWaitForItsFrameButNotTwo) {
  Bench bench;
  const auto beat = [&](double position, bool sends) {
    bench.hear(0x0027, 0);
    const AxisCondition found = bench.condition();
    EXPECT_TRUE(bench.write(AxisState::moving, {.position = position}));
    bench.pack(sends);
    return found;
  };
  EXPECT_EQ(beat(0.1, true), AxisCondition::enabled);
  EXPECT_EQ(beat(0.2, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.3, true), AxisCondition::enabled) << "one frame was not sent";
  EXPECT_EQ(beat(0.4, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.5, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.6, true), AxisCondition::unsent) << "two frames were not sent";
  EXPECT_EQ(beat(0.7, true), AxisCondition::enabled);
}

}  // namespace
}  // namespace takt
