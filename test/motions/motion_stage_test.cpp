#include <gtest/gtest.h>

#include "test/motions/moved_axes.hpp"
#include "test/support/counted_new.hpp"

namespace takt {
namespace {

using motion::AxisState;
using motion::Outcome;
using motion::StopCause;
using test::MovedAxes;

TEST(MotionStage, MovesBothAxesAsOneGroup) {
  MovedAxes bus;
  bus.enable();
  bus.move({1.0, -0.5});
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::moving; }, 10));
  EXPECT_EQ(bus.now.axes[1].state, AxisState::moving) << "they begin in the same beat";
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.ends.size() == 2; }));
  for (const motion::MotionEnd& end : bus.ends) EXPECT_EQ(end.order.outcome, Outcome::done);
  bus.run(10);
  EXPECT_NEAR(bus.position(0), 1.0, 2e-3);
  EXPECT_NEAR(bus.position(1), -0.5, 2e-3);
  EXPECT_TRUE(bus.enabled(0));
}

/// The set-point of each beat is that of the planned motion, rounded to counts: none is left out,
/// and none comes twice.
TEST(MotionStage, WritesTheSetPointOfEachBeat) {
  MovedAxes bus;
  bus.enable();
  bus.move({2.0});
  const Signal& signal = bus.network.plan.layout.signals[bus.axes[0].target];
  int beats = 0;
  bus.each_cycle = [&] {
    bus.keep_alive();
    if (bus.now.axes[0].state != AxisState::moving) return;
    ++beats;
  };
  std::vector<std::int64_t> written;
  ASSERT_TRUE(bus.run_until([&] {
    if (bus.now.axes[0].state == AxisState::moving) {
      const double counts = bus.now.axes[0].commanded.position / signal.scale;
      written.push_back(std::llround(counts));
    }
    // The image shows the outputs of the cycle before.
    if (written.size() > 1) {
      EXPECT_EQ(bus.target(0), written[written.size() - 2]);
    }
    return !bus.ends.empty();
  }));
  EXPECT_GT(beats, 100);
  for (std::size_t i = 2; i < written.size(); ++i) {
    const auto bend = written[i] - 2 * written[i - 1] + written[i - 2];
    // 20 rad/s^2 in 2 ms are 0.13 counts a beat squared, and rounding adds at most two counts.
    EXPECT_LE(std::abs(bend), 2) << i;
  }
}

TEST(MotionStage, AMotionOutlivesItsApplicationByTheTimeoutAndTheDriveIsDisabledAfterTheStop) {
  MovedAxes bus;
  bus.enable();
  bus.move({40.0});
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::moving; }, 10));
  bus.run(240);  // the time to live of the controlword is 500 cycles, some of which have passed
  EXPECT_EQ(bus.now.axes[0].state, AxisState::moving);
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::stopping; }, 20));
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::sender_silent);
  EXPECT_TRUE(bus.enabled(0)) << "the drive stays enabled during its stop";
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::standing; }));
  EXPECT_NEAR(bus.now.axes[0].commanded.velocity, 0.0, 1e-12);
  ASSERT_TRUE(bus.run_until([&] { return !bus.enabled(0); }, 600)) << "its commands have expired";
}

TEST(MotionStage, PointsLeaveRoomForTheOtherMessages) {
  MovedAxes bus;
  bus.enable();
  int points = 0;
  while (points < 1000 && bus.master.submit({.kind = motion::MessageKind::points})) ++points;
  EXPECT_GT(points, 100);
  for (std::size_t i = 0; i < motions_a_cycle; ++i) bus.keep_alive();
  EXPECT_FALSE(bus.master.submit({.kind = motion::MessageKind::heard}));
}

TEST(MotionStage, AnAxisThatStandsIsKeptEnabledWhileItsSenderIsAlive) {
  MovedAxes bus;
  bus.enable();
  bus.move({0.1});
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(2000);  // four times the time to live of the controlword
  EXPECT_TRUE(bus.enabled(0));
  EXPECT_FALSE(bus.enabled(1)) << "nobody commands the other axis";
}

TEST(MotionStage, DirectSetPointsAreRefusedDuringAMotionAndTakenAfterIt) {
  MovedAxes bus;
  bus.enable();
  bus.move({1.0});
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::moving; }, 10));
  bus.each_cycle = [&] {
    bus.keep_alive();
    if (!bus.ends.empty()) return;
    bus.master.set(bus.axes[0].target, 0);
    bus.master.publish_outputs(bus.world.now());
  };
  ASSERT_TRUE(bus.run_until([&] { return !bus.ends.empty(); }));
  EXPECT_EQ(bus.ends[0].order.outcome, Outcome::done);
  bus.run(5);
  const std::int64_t at_rest = bus.target(0);
  EXPECT_NEAR(static_cast<double>(at_rest) * 6.283185307179586e-4, 1.0, 1e-3);
  bus.master.set(bus.axes[0].target, at_rest + 10);
  bus.master.publish_outputs(bus.world.now());
  bus.run(3);
  EXPECT_EQ(bus.target(0), at_rest + 10);
  EXPECT_NEAR(bus.now.axes[0].commanded.position,
              static_cast<double>(at_rest + 10) * 6.283185307179586e-4, 1e-9)
      << "the next motion begins there";
}

TEST(MotionStage, TheGroupStopsIfTheNodeOfOneAxisIsLost) {
  MovedAxes bus{{{.kind = sim::FaultKind::power_off,
                  .node = 1_node,
                  .at = std::chrono::seconds{4},
                  .until = std::chrono::seconds{20}}}};
  bus.enable();
  ASSERT_LT(bus.world.now(), std::chrono::seconds{3});
  bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{3700}; });
  bus.enable();
  bus.move({40.0, 40.0});
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[1].state == AxisState::stopping; }));
  EXPECT_EQ(bus.now.axes[1].stop.cause, StopCause::no_statusword);
  EXPECT_EQ(bus.now.axes[1].stop.axis, 0);
  EXPECT_LT(bus.world.now(), std::chrono::milliseconds{4015});
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::unpowered; }));
  EXPECT_LT(bus.world.now(), std::chrono::milliseconds{4500}) << "its heartbeat is missing";
}

/// The largest second difference of the target positions that the drive of an axis has received, in
/// counts.
class Bend {
 public:
  void observe(std::int64_t target) {
    if (seen_ > 1) most_ = std::max(most_, std::abs(target - 2 * last_ + before_));
    before_ = last_;
    last_ = target;
    ++seen_;
  }
  /// 20 rad/s^2 are 0.13 counts in a beat squared, and rounding adds at most two counts.
  bool is_smooth() const { return most_ <= 2; }

 private:
  std::int64_t last_ = 0;
  std::int64_t before_ = 0;
  std::int64_t most_ = 0;
  int seen_ = 0;
};

/// A drive in cyclic synchronous position mode may ignore a Halt, as the simulated one does.
TEST(MotionStage, AHaltStopsTheAxisWithoutAStepOfItsTarget) {
  MovedAxes bus;
  bus.enable();
  bus.move({40.0});
  Bend bend;
  bus.each_cycle = [&] {
    bus.keep_alive();
    bend.observe(bus.target(0));
  };
  bus.run(300);
  bus.master.set(*bus.axes[0].controlword, 0x010F);
  bus.master.publish_outputs(bus.world.now());
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::stopping; }, 5));
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::halted);
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::standing; }));
  bus.run(100);
  EXPECT_TRUE(bend.is_smooth());
  EXPECT_EQ(bus.now.axes[0].state, AxisState::standing);
}

TEST(MotionStage, MissingStatuswordsStopTheAxisWithoutAStepOfItsTarget) {
  MovedAxes bus{{{.kind = sim::FaultKind::mute_pdo,
                  .node = 1_node,
                  .at = std::chrono::milliseconds{3500},
                  .until = std::chrono::milliseconds{3520}}}};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{2900}; });
  bus.enable();
  bus.move({40.0});
  Bend bend;
  bus.each_cycle = [&] {
    bus.keep_alive();
    bend.observe(bus.target(0));
  };
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::stopping; }, 400));
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::no_statusword);
  EXPECT_LT(bus.world.now(), std::chrono::milliseconds{3515});
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::standing; }));
  bus.run(100);
  EXPECT_TRUE(bend.is_smooth());
  EXPECT_TRUE(bus.enabled(0));
}

/// The file permits 4 rad/s.
TEST(MotionStage, AfterARefusedSetPointTheDriveIsEnabledAgainWhereItStands) {
  MovedAxes bus{{}, MovedAxes::velocity_offset};
  bus.enable();
  motion::Limits fast = MovedAxes::limits;
  fast.max_velocity = 5.0;
  fast.min_velocity = -5.0;
  bus.move({40.0}, fast);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.said(EventKind::limit_exceeded); }));
  bus.cycle();
  EXPECT_EQ(bus.velocity_offset_of(0), 0) << "in the cycle of the refusal";
  EXPECT_EQ(bus.now.axes[0].state, AxisState::standing);
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::limit);
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::unpowered; }));
  bus.run(1000);
  const double rest = bus.position(0);
  EXPECT_NEAR(static_cast<double>(bus.target(0)) * 6.283185307179586e-4, rest, 1e-3);
  bus.events.clear();
  bus.enable();
  bus.run(100);
  EXPECT_FALSE(bus.said(EventKind::limit_exceeded));
  EXPECT_NEAR(bus.position(0), rest, 1e-3);
}

/// The file permits 100 rad/s^2. A motion that ends at once from 2.5 rad/s has 1250 rad/s^2.
TEST(MotionStage, AfterAGapOfSyncTheAxesStandEnabledAtTheirLastSetPoints) {
  MovedAxes bus{{{.kind = sim::FaultKind::stall_master,
                  .at = std::chrono::milliseconds{3500},
                  .until = std::chrono::milliseconds{3520}}},
                MovedAxes::velocity_offset};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{2900}; });
  bus.enable();
  bus.move({40.0, 0.001});
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.events.clear();
  ASSERT_TRUE(
      bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{3490}; }, 400));
  ASSERT_GT(bus.now.axes[0].commanded.velocity, 2.5);
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state != AxisState::moving; }, 20));
  EXPECT_EQ(bus.now.axes[0].state, AxisState::standing);
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::no_sync);
  bus.cycle();
  EXPECT_EQ(bus.velocity_offset_of(0), 0);
  bus.move({-1.0});
  bus.run(1000);
  EXPECT_FALSE(bus.said(EventKind::limit_exceeded));
  EXPECT_FALSE(bus.said(EventKind::fallback_begun));
  EXPECT_TRUE(bus.enabled(0));
  EXPECT_TRUE(bus.enabled(1)) << "it stood";
  EXPECT_NEAR(bus.position(0), -1.0, 2e-3);
}

/// The master continues with its cycles, but can't send in them.
TEST(MotionStage, ADriveIsKeptEnabledWhileSyncIsMissingAndItsSenderIsAlive) {
  MovedAxes bus{{{.kind = sim::FaultKind::interface_down,
                  .at = std::chrono::milliseconds{4500},
                  .until = std::chrono::milliseconds{4530}}}};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{2900}; });
  bus.enable();
  bus.move({0.001});
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.events.clear();
  ASSERT_TRUE(bus.run_until([&] { return bus.world.now() > std::chrono::milliseconds{4500}; }));
  const std::uint64_t beat = bus.now.cycle;
  bus.run(10);
  EXPECT_LE(bus.now.cycle, beat + 1);
  bus.run(50);
  EXPECT_GT(bus.now.cycle, beat + 10);
  EXPECT_TRUE(bus.enabled(0));
}

TEST(MotionStage, AnOrderedStopEndsEachMotion) {
  MovedAxes bus;
  bus.enable();
  bus.move({40.0, 40.0});
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(200);
  bus.master.request_stop();
  ASSERT_TRUE(bus.run_until([&] { return bus.ends.size() == 2; }));
  for (const motion::MotionEnd& end : bus.ends) {
    EXPECT_EQ(end.order.outcome, Outcome::stopped);
    EXPECT_EQ(end.stop.cause, StopCause::ordered_stop);
  }
  ASSERT_TRUE(bus.run_until([&] { return bus.master.finished(); }));
}

TEST(MotionStage, TheBusThreadAllocatesNothingWhileAxesBeginMoveAndStop) {
  MovedAxes bus;
  bus.enable();
  bus.move({40.0, 40.0});
  std::uint64_t made = 0;
  for (int i = 0; i < 400; ++i) {
    if (i == 300) bus.stop(0);
    ++bus.last_cycle;
    bus.keep_alive();
    const std::uint64_t before = allocations();
    bus.master.cycle();
    made += allocations() - before;
  }
  bus.master.motions(bus.now);
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::application);
  EXPECT_EQ(made, 0U);
}

TEST(MotionStage, TheBusThreadAllocatesNothingWhileAnAxisFollowsAStream) {
  MovedAxes bus;
  bus.enable();
  motion::MotionMessage message{.kind = motion::MessageKind::order};
  message.order = {.id = 1,
                   .ending = motion::Ending::points,
                   .begin = bus.now.cycle + 3,
                   .from = bus.now.axes[0].commanded,
                   .profile = {},
                   .stop = MovedAxes::limits,
                   .timeout = 250};
  ASSERT_TRUE(bus.master.submit(message));
  message = {.kind = motion::MessageKind::points, .axis = 0};
  message.points.order = 1;
  message.points.size = 4;
  for (std::size_t i = 0; i < 4; ++i) {
    const double step = static_cast<double>(i + 1);
    message.points.points[i] = {.time = 0.1 * step,
                                .state = {.position = 0.02 * step, .velocity = 0.1}};
  }
  ASSERT_TRUE(bus.master.submit(message));
  std::uint64_t made = 0;
  for (int i = 0; i < 400; ++i) {
    ++bus.last_cycle;
    bus.keep_alive();
    const std::uint64_t before = allocations();
    bus.master.cycle();
    made += allocations() - before;
    bus.master.motions(bus.now);
    if (i == 150) {
      EXPECT_EQ(bus.now.axes[0].state, AxisState::moving);
    }
  }
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::points_ended);
  EXPECT_EQ(made, 0U);
}

TEST(MotionStage, AStopOfTheApplicationActsInTheNextBeat) {
  MovedAxes bus;
  bus.enable();
  bus.move({40.0, 40.0});
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(200);
  bus.stop(1);
  bus.cycle();
  EXPECT_EQ(bus.now.axes[0].state, AxisState::stopping);
  EXPECT_EQ(bus.now.axes[0].stop.cause, StopCause::application);
  ASSERT_TRUE(bus.run_until([&] { return bus.now.axes[0].state == AxisState::standing; }));
  EXPECT_TRUE(bus.enabled(0));
}

}  // namespace
}  // namespace takt
