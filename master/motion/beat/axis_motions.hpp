#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/axis_runner.hpp"
#include "master/motion/beat/motion_order.hpp"

namespace takt::motion {

/// The motions of all axes of a bus, and their groups. After construction it allocates nothing.
class AxisMotions {
 public:
  /// `axes` is at most max_axes, `period` is the period of the cycle in s.
  AxisMotions(std::size_t axes, double period);

  /// Takes an order before its first cycle or in it. This is no sign of life of its sender, because
  /// the order may have been planned late. Returns a refusal, or Outcome::none if the order waits
  /// for its first cycle.
  Outcome take(const MotionOrder& order) noexcept;
  /// Notes that the sender was alive in this cycle, which is the present one or an earlier one.
  void sender_heard(std::uint8_t sender, CycleNumber cycle) noexcept;
  /// Appends points to the stream that the axis follows or is about to follow. If one does not fit,
  /// the stream ends before it.
  void add_points(std::uint8_t axis, const StreamPoints& points) noexcept {
    if (axis < runners_.size()) runners_[axis].add_points(points);
  }
  /// Notes that the sender has named this axis in a message. A jog ends if its sender does not name
  /// its axis any longer, even if the sender sends other messages.
  void renew_jog(std::uint8_t axis, const LifeSign& sign) noexcept {
    if (axis < runners_.size()) runners_[axis].renew_jog(sign);
  }
  /// Notes that the sender may not command this axis any longer. If the newest motion of the axis
  /// is from this sender, the sender counts as silent from now on.
  void sender_left(std::uint8_t axis, std::uint8_t sender) noexcept;
  /// Stops the axis and its group in the next run(), each axis along its own limits. An order of
  /// the axis that waits ends as well.
  void stop_axis(std::uint8_t axis, StopCause cause) noexcept;
  /// Stops all axes as stop_axis() does.
  void stop_all(StopCause cause) noexcept;

  /// Ends the gear of the axis. The axis keeps its velocity until its next motion begins; if no
  /// motion begins soon, it stops.
  void release_gear(std::uint8_t axis) noexcept {
    if (axis < runners_.size()) runners_[axis].release_gear();
  }
  /// Returns the signals that AxisInput::leaders needs in the run() of this cycle.
  LeaderSignals leader_signals(std::size_t axis, CycleNumber cycle) const noexcept {
    return runners_[axis].leader_signals(cycle);
  }

  /// Runs one cycle. `inputs` has one element for each axis. The result has one element for each
  /// axis, too, and is valid until the next call.
  std::span<const AxisReport> run(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept;
  /// Ends the motion of the axis at once, because its last set-point did not reach the drive. The
  /// other axes of its group stop along their limits. The axis is not kept alive any longer.
  void abandon(std::uint8_t axis, StopCause cause) noexcept;
  /// Ends all motions at once.
  void abandon_all(StopCause cause) noexcept;
  /// Returns true if the drive of the axis has to stay enabled in a cycle without SYNC.
  bool outlives_gap(std::uint8_t axis, CycleNumber cycle) const noexcept;
  /// Returns the reports of the last run().
  std::span<const AxisReport> reports() const noexcept { return reports_; }

  /// Returns the number of points that wait in the streams of all axes. Each point adds
  /// StreamPoint::kept_words to keep().
  std::size_t points() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(runners_, reports_, heard_);
    for (std::size_t i = 0; i < runners_.size(); ++i) state(stops_[i]);
  }

 private:
  /// A stop of the axes of a group whose newest motion has this id, or of all axes of the group.
  struct GroupStop {
    Stop stop;
    std::uint32_t id = 0;
    bool of_all = false;

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(stop, id, of_all);
    }
  };

  void add_stop(std::size_t axis, StopCause cause) noexcept;
  void observe(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept;
  void stop_groups() noexcept;
  void begin_orders(CycleNumber cycle) noexcept;
  void stop_split_streams() noexcept;
  void run_axes(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept;
  void follow(std::size_t axis, std::span<const AxisInput> inputs) noexcept;
  Outcome objection_of(std::size_t axis, CycleNumber cycle) noexcept;
  CycleNumber silence_of(std::uint8_t sender, CycleNumber cycle) const noexcept;

  std::vector<AxisRunner> runners_;
  std::vector<AxisReport> reports_;
  /// Stop of the group in the next cycle, indexed by group.
  std::array<GroupStop, max_axes> stops_{};
  std::array<CycleNumber, max_axes> heard_{};  ///< newest sign of life, indexed by sender
};

}  // namespace takt::motion
