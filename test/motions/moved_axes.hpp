#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <utility>
#include <vector>

#include "master/motion/trajectory.hpp"
#include "test/motions/axes_in_virtual_time.hpp"

namespace takt::test {

/// Two axes in virtual time, and an application that enables them
/// by set-points and moves them by orders.
class MovedAxes final : public AxesInVirtualTime {
 public:
  static constexpr motion::Limits limits{.max_velocity = 3.0,
                                         .min_velocity = -3.0,
                                         .max_acceleration = 20.0,
                                         .min_acceleration = -20.0,
                                         .jerk = 400.0};

  explicit MovedAxes(sim::Faults faults = {}, const char* file = demo)
      : AxesInVirtualTime{std::move(faults), file} {
    begin();
  }

  /// Boots and enables both axes; from then on no set-point is sent.
  void enable() {
    commands = true;
    ASSERT_TRUE(run_until([&] { return enabled(0) && enabled(1); }));
    commands = false;
    keep_alive();
    cycle();
    ASSERT_EQ(now.axes[0].state, motion::AxisState::standing);
  }
  bool enabled(std::size_t axis) const {
    return !values.empty() && (values[axes[axis].statusword] & 0x6F) == 0x27;
  }
  /// Sends a sign of life of the sender of all orders.
  void keep_alive() {
    EXPECT_TRUE(master.submit({.kind = motion::MessageKind::heard, .cycle = last_cycle}));
  }
  void stop(std::uint8_t axis) {
    EXPECT_TRUE(master.submit({.kind = motion::MessageKind::stop, .sender = 0, .axis = axis}));
  }

  /// Moves the axes from standstill to these positions as one group.
  void move(std::vector<double> targets, motion::Limits within = limits) {
    std::vector<motion::AxisTask> tasks;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      tasks.push_back(
          {.from = now.axes[i].commanded, .to = {.position = targets[i]}, .limits = within});
    }
    std::vector<motion::PlannedAxis> planned(tasks.size());
    ASSERT_TRUE(motion::plan_trajectory(tasks, {}, planned).has_value());
    ++id;
    keep_alive();
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      motion::MotionMessage message{.kind = motion::MessageKind::order};
      message.order = {.id = id,
                       .axis = static_cast<std::uint8_t>(i),
                       .axes = static_cast<std::uint8_t>(tasks.size()),
                       .begin = now.cycle + 3,
                       .from = tasks[i].from,
                       .profile = planned[i].profile,
                       .stop = within,
                       .timeout = 250,  // 500 ms
                       .max_following_error = 0.5};
      ASSERT_TRUE(master.submit(message));
    }
  }

  double position(std::size_t axis) const {
    const Signal& signal = network.plan.layout.signals[axes[axis].position];
    return static_cast<double>(values[axes[axis].position]) * signal.scale + signal.offset;
  }
  std::int64_t target(std::size_t axis) const { return values[axes[axis].target]; }
  std::int64_t velocity_offset_of(std::size_t axis) const {
    return values[*axes[axis].velocity_offset];
  }
  bool said(EventKind kind) const {
    return std::ranges::find(events, kind, &Event::kind) != events.end();
  }

  std::vector<std::int64_t> values;  ///< of the newest image
  MotionSnapshot now;
  std::vector<motion::MotionEnd> ends;
  std::vector<Event> events;
  std::uint64_t last_cycle = 0;
  std::uint32_t id = 0;
  bool commands = false;

 private:
  void run_cycle() override {
    if (commands) command_drives();
    master.cycle();
    ImageView image;
    if (master.take_newest(image)) {
      values.assign(image.values.begin(), image.values.end());
      last_cycle = image.cycle;
    }
    master.motions(now);
    for (motion::MotionEnd end; master.take(end);) ends.push_back(end);
    for (Event event; master.take(event);) events.push_back(event);
  }
  std::optional<SignalIndex> output(std::size_t axis, std::uint16_t index) const {
    const auto& signals = network.plan.layout.signals;
    for (std::size_t i = network.plan.layout.inputs; i < signals.size(); ++i) {
      if (signals[i].node_index == axes[axis].node_index && signals[i].object.index == index) {
        return static_cast<SignalIndex>(i);
      }
    }
    return std::nullopt;
  }
  /// Commands each drive to Operation enabled in cyclic synchronous position mode.
  void command_drives() {
    for (std::size_t axis = 0; axis < axes.size() && !values.empty(); ++axis) {
      const std::int64_t word = values[axes[axis].statusword];
      const std::int64_t next = (word & 0x4F) == 0x40 ? 0x06 : (word & 0x6F) == 0x21 ? 0x07 : 0x0F;
      master.set(*output(axis, 0x6040), next);
      master.set(*output(axis, 0x6060), 8);
      master.set(axes[axis].target, values[axes[axis].position]);
    }
    master.publish_outputs(world.now());
  }
};

}  // namespace takt::test
