#include "master/core/network/ordered_stop.hpp"

#include <array>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t operation_enabled = 0x0237;
constexpr std::int64_t quick_stop_active = 0x0217;
constexpr std::int64_t switch_on_disabled = 0x0250;

/// The stop of two axes, stepped every 2 ms. The positions change by `speed` counts per step. A
/// frame of each axis comes in every `every`-th step.
class Stop {
 public:
  explicit Stop(std::int64_t word = operation_enabled, BusPlan of = test::axes())
      : plan{std::move(of)}, machine{plan}, values(plan.layout.signals.size(), 0) {
    words = {word, word};
    machine.begin(now, nodes);
  }
  /// Begins again; the axes were seen disabled, and nothing could enable them since.
  void begin_with_memory() {
    std::array<AxisMemory, 2> memory;
    for (AxisMemory& axis : memory) {
      for (int i = 0; i < 10; ++i) axis.look(switch_on_disabled, std::nullopt);
    }
    machine.call_off();
    machine.begin(now, nodes, OrderedStop::every_node, memory);
  }
  void step(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now += 2ms;
      place[0] += speed[0];
      place[1] += speed[1];
      ++steps;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (every[axis] == 0 || steps % every[axis] != 0) continue;
        ++marks[axis].received;
        values[axis] = words[axis];
        values[2 + axis] = place[axis];
      }
      machine.step(now, {.received = {.values = values, .stale = stale, .marks = marks},
                         .exchanging = exchanging,
                         .nodes = nodes,
                         .disarmed = disarmed,
                         .network_stopped = stopped});
    }
  }
  void step_until(StopStage stage) {
    for (int i = 0; i < 10000 && machine.stage() != stage; ++i) step();
    ASSERT_EQ(machine.stage(), stage);
  }
  AxisVerdict verdict(std::size_t axis) const {
    return machine.axis(axis).verdict(now, exchanging[axis]);
  }

  BusPlan plan;
  OrderedStop machine;
  std::vector<std::int64_t> values;
  std::array<std::int64_t, 2> words{};
  std::array<std::int64_t, 2> speed{};
  std::array<std::int64_t, 2> place{};
  std::array<int, 2> every{1, 1};
  int steps = 0;
  std::array<PdoMark, 2> marks{};
  std::array<std::uint64_t, 1> stale{};
  std::array<bool, 2> exchanging{true, true};
  std::array<NodeStatus, 2> nodes{NodeStatus{.boot = BootState::ready, .boot_count = 1},
                                  NodeStatus{.boot = BootState::ready, .boot_count = 1}};
  bool disarmed = true;
  bool stopped = false;
  Time now = 1s;
};

TEST(OrderedStop, FindsTheAxesOfThePlan) {
  Stop stop;
  ASSERT_EQ(stop.machine.axes().size(), 2U);
  EXPECT_EQ(stop.machine.axes()[1].controlword, 5);
  EXPECT_EQ(stop.machine.axes()[1].statusword, 1);
  EXPECT_EQ(stop.machine.axes()[1].position, 3);
  EXPECT_FALSE(stop.machine.axes()[1].velocity);
}

TEST(OrderedStop, GoesFromFallbackToQuickStop) {
  Stop stop;
  stop.speed = {100, 100};
  EXPECT_EQ(stop.machine.stage(), StopStage::fallback);
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::fallback);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "whatever its fallback is";
  stop.step_until(StopStage::quick_stop);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);
  EXPECT_LT(stop.now - 1s, 20ms);
}

TEST(OrderedStop, DisablesAnAxisWhenItWasSeenAtStandstill) {
  Stop stop;
  stop.speed = {100, 100};
  stop.words[0] = stop.words[1] = quick_stop_active;  // 605A = 6: the axis stays in this state
  stop.step(200);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);

  stop.speed[0] = 0;
  stop.step(20);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "40 ms at rest are too few";
  stop.step(20);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  EXPECT_EQ(stop.machine.controlword(1), 0x0002) << "the other one still moves";
}

TEST(OrderedStop, GoesOnOnlyWhenEveryAxisIsDisabled) {
  Stop stop;
  stop.step(50);
  stop.words[0] = switch_on_disabled;
  stop.step(100);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
  stop.words[1] = switch_on_disabled;
  stop.step(2);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, ConfirmsAxesThatWereDisabledAtTheBeginning) {
  Stop stop{switch_on_disabled};
  stop.speed = {100, 0};  // a person turns the axis by hand
  stop.begin_with_memory();
  stop.step(10);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, LeavesTheFallbackOnlyToAnAxisThatWasDisabledBefore) {
  Stop stop{switch_on_disabled};
  stop.begin_with_memory();
  stop.step();
  EXPECT_FALSE(stop.machine.controlword(0)) << "its fallback";

  Stop unknown;
  unknown.every = {0, 0};
  unknown.step();
  EXPECT_EQ(unknown.machine.controlword(0), 0x0002) << "it may be enabled";
}

TEST(OrderedStop, ConfirmsADriveThatDisablesItselfAtTheEndOfItsRamp) {
  Stop stop;
  for (stop.speed = {200, 200}; stop.speed[0] > 0; stop.speed[0] = stop.speed[1] -= 1) stop.step();
  stop.words[0] = stop.words[1] = switch_on_disabled;  // 605A = 2
  stop.step(10);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop) << "is it at rest?";
  stop.step(30);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, DoesNotConfirmADriveThatCoasts) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step(20);
  stop.words[0] = stop.words[1] = switch_on_disabled;  // 605A = 0
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);  // 150 counts in 2 ms
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped);
}

/// Two drives that a quick stop disables at once (605A = 0).
BusPlan coasting() {
  BusPlan plan = test::axes();
  for (NodePlan& node : plan.nodes) node.axes = {AxisPlan{.quick_stop_option = 0}};
  return plan;
}

TEST(OrderedStop, DoesNotConfirmADriveThatTheQuickStopDisablesWhileItMoves) {
  Stop stop{operation_enabled, coasting()};
  stop.speed = {150, 0};
  stop.step(10);
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.speed = {};
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::unproven) << "positions over 18 ms show no standstill";
}

/// The first statusword of the stop shows that the quick stop has disabled the drive.
TEST(OrderedStop, RemembersTheVelocityFromBeforeTheQuickStop) {
  for (const std::int64_t velocity : {8000, 0}) {
    BusPlan plan = coasting();
    plan.layout.signals[2].object = ObjectKey{0x606C, 0};
    Stop stop{operation_enabled, plan};
    stop.place[0] = velocity;
    stop.step();
    stop.words[0] = switch_on_disabled;
    stop.place[0] = 0;
    stop.step(40);
    EXPECT_EQ(stop.verdict(0), velocity == 0 ? AxisVerdict::stopped : AxisVerdict::moving);
    EXPECT_EQ(stop.machine.axis(0).velocity(), velocity);
  }
}

TEST(OrderedStop, DoesNotDisableAMovingAxisAsLongAsThereIsTime) {
  Stop stop;
  stop.speed = {150, 0};
  while (stop.now - 1s < 3950ms) {
    stop.step();
    if (stop.machine.stage() != StopStage::fallback) {
      ASSERT_EQ(stop.machine.controlword(0), 0x0002);
    }
  }
}

TEST(OrderedStop, TellsAtWhichVelocityAnAxisWasDisabled) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step_until(StopStage::disable);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  stop.words[0] = stop.words[1] = switch_on_disabled;
  stop.speed = {};
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);
}

TEST(OrderedStop, TellsAnAxisThatStaysEnabled) {
  Stop stop;
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::enabled);
}

TEST(OrderedStop, TellsForHowLongAnAxisGaveNoAnswer) {
  Stop stop;
  stop.words[0] = switch_on_disabled;
  stop.step(10);
  stop.every = {1, 0};
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::silent);
  EXPECT_GT(stop.machine.axis(1).silence(stop.now), 4s);
}

TEST(OrderedStop, DoesNotTakeAnOldStatuswordForAnAnswer) {
  Stop stop;
  stop.values[0] = stop.values[1] = switch_on_disabled;  // from before the stop
  stop.every = {0, 0};
  stop.step(500);
  EXPECT_EQ(stop.machine.axis(0).state(), AxisState::unseen);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);
}

/// The frames come every 60 ms, and the axis moves 100 counts in 2 ms.
TEST(OrderedStop, DoesNotTakeARepeatedPositionForStandstill) {
  Stop stop;
  stop.every = {30, 30};
  stop.speed = {100, 100};
  for (int i = 0; i < 1500; ++i) {
    stop.step();
    ASSERT_EQ(stop.machine.controlword(0), 0x0002) << i;
  }
  stop.speed = {};
  stop.step(59);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "two frames at rest are too few";
  stop.step(1);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(60);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

/// The first frame in the stop is lost. The drive coasts after the quick stop (605A = 0).
TEST(OrderedStop, DoesNotTakeItsOwnCommandForTheStateAtTheBeginning) {
  Stop stop;
  stop.speed = {150, 0};
  stop.every = {0, 0};
  stop.step(3);
  stop.every = {1, 1};
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped) << "it was seen at standstill";
}

TEST(OrderedStop, NeedsAnSdoWhereNoFrameComes) {
  Stop stop;
  stop.step(10);
  EXPECT_FALSE(stop.machine.needs_word(0, stop.now));
  EXPECT_FALSE(stop.machine.needs_motion(0, stop.now));
  stop.every = {0, 1};
  stop.step(24);
  EXPECT_FALSE(stop.machine.needs_word(0, stop.now));
  stop.step(1);
  EXPECT_TRUE(stop.machine.needs_word(0, stop.now)) << "50 ms without a frame";
  EXPECT_TRUE(stop.machine.needs_motion(0, stop.now));
  EXPECT_FALSE(stop.machine.needs_word(1, stop.now));
  stop.stale[0] = 0b1010;
  stop.step(1);
  EXPECT_TRUE(stop.machine.needs_word(1, stop.now)) << "its TPDO is missing";
}

TEST(OrderedStop, NeedsAnSdoWhereFramesComeTooSlowly) {
  struct Rate {
    std::uint8_t transmission = 0;
    Time inhibit{};
    Time event_timer{};
  };
  for (const Rate slow : {Rate{.transmission = 26}, Rate{.transmission = 255, .inhibit = 100ms},
                          Rate{.transmission = 254, .event_timer = 200ms}}) {
    BusPlan plan = test::axes();
    plan.pdos.tpdos[0].transmission = slow.transmission;
    plan.pdos.tpdos[0].inhibit = slow.inhibit;
    plan.pdos.tpdos[0].event_timer = slow.event_timer;
    Stop stop{operation_enabled, plan};
    stop.step(10);
    EXPECT_TRUE(stop.machine.needs_word(0, stop.now)) << int{slow.transmission};
    EXPECT_TRUE(stop.machine.needs_motion(0, stop.now));
    EXPECT_FALSE(stop.machine.needs_word(1, stop.now));
  }
}

TEST(OrderedStop, NeverConfirmsADriveWhoseNodeIsLost) {
  Stop stop;
  stop.step(10);
  stop.words[0] = stop.words[1] = switch_on_disabled;
  stop.exchanging[1] = false;
  stop.step(300);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  stop.step(300);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt) << "the others wait a second for it";
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::lost);
}

TEST(OrderedStop, HasNothingToConfirmOfANodeThatNeverWasReady) {
  Stop stop{switch_on_disabled};
  stop.exchanging[1] = false;
  stop.nodes[1] = NodeStatus{.boot = BootState::failed};
  stop.begin_with_memory();
  stop.step(10);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, TakesWhatAnSdoHasReadWhereNoPdoBringsIt) {
  Stop stop;
  stop.exchanging = {true, false};
  stop.words[0] = switch_on_disabled;
  for (int i = 0; i < 20; ++i) {
    stop.machine.take(1,
                      AxisSample{.statusword = quick_stop_active, .velocity = {}, .position = {}});
    stop.machine.take(1, AxisSample{.statusword = {}, .velocity = 3, .position = {}});
    stop.step(5);
  }
  EXPECT_EQ(stop.machine.axis(1).state(), AxisState::standing);
  stop.machine.take(1,
                    AxisSample{.statusword = switch_on_disabled, .velocity = {}, .position = {}});
  stop.step(2);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, WaitsUntilEverythingIsDisarmed) {
  Stop stop{switch_on_disabled};
  stop.disarmed = false;
  stop.step_until(StopStage::disarm);
  stop.step(5);
  EXPECT_EQ(stop.machine.stage(), StopStage::disarm);
  stop.disarmed = true;
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
}

TEST(OrderedStop, LeavesEverythingArmedWhereAnAxisIsNotConfirmed) {
  Stop stop;
  stop.disarmed = false;
  while (stop.machine.stage() != StopStage::done) {
    stop.step();
    ASSERT_NE(stop.machine.stage(), StopStage::disarm);
  }
}

TEST(OrderedStop, EndsWithinItsTimeWhateverHappens) {
  Stop stop;  // nobody answers, the network never stops
  stop.step_until(StopStage::done);
  EXPECT_LE(stop.now - 1s, 5s);
}

TEST(OrderedStop, EndsWhenTheNetworkHasStopped) {
  Stop stop{0x0008};  // fault: no power
  stop.step_until(StopStage::nmt);
  stop.step(5);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
  stop.stopped = true;
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::done);
}

TEST(OrderedStop, CountsOnlyPowerlessStatesAsDisabled) {
  EXPECT_TRUE(OrderedStop::disabled(0x0250));   // switch on disabled
  EXPECT_TRUE(OrderedStop::disabled(0x0000));   // not ready to switch on
  EXPECT_TRUE(OrderedStop::disabled(0x0238));   // fault
  EXPECT_TRUE(OrderedStop::disabled(0x0231));   // ready to switch on
  EXPECT_FALSE(OrderedStop::disabled(0x0233));  // switched on
  EXPECT_FALSE(OrderedStop::disabled(0x0237));  // operation enabled
  EXPECT_FALSE(OrderedStop::disabled(0x0217));  // quick stop active
  EXPECT_FALSE(OrderedStop::disabled(0x021F));  // fault reaction active
}

}  // namespace
}  // namespace takt
