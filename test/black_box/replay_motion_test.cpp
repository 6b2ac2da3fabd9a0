#include <array>
#include <gtest/gtest.h>
#include <random>

#include "eds_parser/table/motion_axes.hpp"
#include "master/black_box/recording_file.hpp"
#include "master/motion/trajectory.hpp"
#include "test/black_box/recorded_run.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using motion::AxisState;
using test::Folder;
using test::RecordedRun;
using test::replay_file;

constexpr motion::Limits limits{.max_velocity = 3.0,
                                .min_velocity = -3.0,
                                .max_acceleration = 20.0,
                                .min_acceleration = -20.0,
                                .jerk = 400.0};

/// Enables both axes, then moves and stops them at random. Some of its signs of life are missing.
class RestlessFront {
 public:
  explicit RestlessFront(RecordedRun& run) : run_{run} {
    run.each_cycle = [this] { step(); };
  }

  int motions_done() const { return done_; }
  int motions_stopped() const { return stopped_; }

 private:
  void step() {
    Exchange& exchange = *run_.exchange;
    exchange.motion_board.read(now_);
    for (motion::MotionEnd end; exchange.motion_ends.pop(end);) {
      done_ += end.order.outcome == motion::Outcome::done;
      stopped_ += end.order.outcome == motion::Outcome::stopped;
    }
    if (run_.world.now() < 1500ms) return enable();
    if (random_() % 200 != 0)
      exchange.motions.push({.kind = motion::MessageKind::heard, .cycle = ~0ULL});
    if (now_.cycle == 0) return;
    for (std::uint8_t axis = 0; axis < now_.axes.size(); ++axis) {
      if (random_() % 50 == 0 && now_.axes[axis].state == AxisState::standing) move(axis);
    }
    if (random_() % 300 == 0) {
      exchange.motions.push({.kind = motion::MessageKind::stop, .sender = 0, .axis = 1});
    }
  }
  /// Commands each state for longer than the drive needs to reach it.
  void enable() {
    const std::int64_t word = run_.world.now() < 1200ms ? 0x06 : run_.world.now() < 1350ms ? 7 : 15;
    const ImageLayout& layout = run_.network.plan.layout;
    for (std::size_t i = 0; i < layout.outputs(); ++i) {
      const std::uint16_t object = layout.signals[layout.inputs + i].object.index;
      if (object == 0x6040) run_.exchange->set_points.set(i, word, 500);
      if (object == 0x6060) run_.exchange->set_points.set(i, 8, 500);
      if (object == 0x607A) run_.exchange->set_points.set(i, 0, 500);
    }
    run_.exchange->set_points.publish(run_.world.now());
    run_.exchange->motions.push({.kind = motion::MessageKind::heard, .cycle = ~0ULL});
  }
  void move(std::uint8_t axis) {
    const motion::State from = now_.axes[axis].commanded;
    const double target = std::uniform_real_distribution<double>{-1.0, 1.0}(random_);
    const std::array tasks{
        motion::AxisTask{.from = from, .to = {.position = target}, .limits = limits}};
    std::array<motion::PlannedAxis, 1> planned;
    if (!motion::plan_trajectory(tasks, {}, planned)) return;
    motion::MotionMessage message{.kind = motion::MessageKind::order};
    message.order = {.id = ++id_,
                     .axis = axis,
                     .group = axis,
                     .begin = now_.cycle + 3,
                     .from = from,
                     .profile = planned[0].profile,
                     .stop = limits,
                     .timeout = 5};
    if (id_ % 3 == 0) message.order.ending = motion::Ending::points;
    run_.exchange->motions.push(message);
    if (id_ % 3 == 0) stream(axis, from);
  }
  /// Sends points to the order that was sent last. The axis ends at rest, or moves at the last
  /// point.
  void stream(std::uint8_t axis, const motion::State& from) {
    motion::MotionMessage message{.kind = motion::MessageKind::points, .axis = axis};
    message.points.order = id_;
    message.points.size = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      message.points.points[i] = {.time = 0.1 * static_cast<double>(i + 1),
                                  .state = {.position = from.position + 0.01,
                                            .velocity = i == 2 && id_ % 2 == 0 ? 0.05 : 0.0},
                                  .curve = i == 1 ? motion::Curve::cubic : motion::Curve::quintic};
    }
    run_.exchange->motions.push(message);
  }

  RecordedRun& run_;
  std::mt19937_64 random_{11};
  MotionSnapshot now_;
  std::uint32_t id_ = 0;
  int done_ = 0;
  int stopped_ = 0;
};

TEST(Replay, OfMotionsTakesTheSameDecisionsFromTheStartAndFromEachCheckpoint) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", {}, 1 << 20};
  RestlessFront front{run};
  run.run_until(8s);
  run.stop();
  run.write_tape(folder / "motions", run.journal.last());
  EXPECT_GT(front.motions_done(), 5);
  EXPECT_GT(front.motions_stopped(), 5);

  auto recording = read_recording(folder / "motions.log");
  ASSERT_TRUE(recording) << recording.error();
  int checkpoints = 0;
  while (begin_with_checkpoint(*recording)) {
    const auto outcome = replay(run.network.plan, *recording, [](const Decision&) {});
    ASSERT_FALSE(outcome.difference) << "checkpoint " << checkpoints << ", then " << outcome.cycles
                                     << " cycles: " << *outcome.difference;
    ++checkpoints;
  }
  EXPECT_GT(checkpoints, 5);
}

}  // namespace
}  // namespace takt
