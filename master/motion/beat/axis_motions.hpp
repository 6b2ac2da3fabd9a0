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
  /// `axes` is at most max_axes, `period` is that of the cycle in s.
  AxisMotions(std::size_t axes, double period);

  /// Takes an order before its first cycle or in it. This is no sign of life of its sender, because
  /// the order may have been planned late. Returns a refusal, or Outcome::none if the order waits
  /// for its first cycle.
  Outcome take(const MotionOrder& order) noexcept;
  /// The sender was alive in this cycle, which is not later than the present one.
  void sender_heard(std::uint8_t sender, CycleNumber cycle) noexcept;
  /// Appends points to the stream that the axis follows or is about to follow. If one does not fit,
  /// the stream ends before it.
  void add_points(std::uint8_t axis, const StreamPoints& points) noexcept {
    if (axis < runners_.size()) runners_[axis].add_points(points);
  }
  /// The sender has named this axis in a message. A jog ends by the silence about its axes,
  /// whatever else its sender says.
  void renew_jog(std::uint8_t axis, const LifeSign& sign) noexcept {
    if (axis < runners_.size()) runners_[axis].renew_jog(sign);
  }
  /// The sender may not command this axis any longer. If it is that of the newest motion, it counts
  /// as silent from now on.
  void sender_left(std::uint8_t axis, std::uint8_t sender) noexcept;
  /// Stops the axis and its group, each axis along its own limits, in the next run(). An order of
  /// the axis that waits ends as well.
  void stop_axis(std::uint8_t axis, StopCause cause) noexcept;
  /// Does the same for all axes.
  void stop_all(StopCause cause) noexcept;

  /// The axis ends its gear, and keeps its velocity until its next motion begins, or stops soon.
  void release_gear(std::uint8_t axis) noexcept {
    if (axis < runners_.size()) runners_[axis].release_gear();
  }
  /// The signals of AxisInput::leaders in the run() of this cycle.
  LeaderSignals leader_signals(std::size_t axis, CycleNumber cycle) const noexcept {
    return runners_[axis].leader_signals(cycle);
  }

  /// Runs one cycle. `inputs` has one element for each axis. The result has one, too; it is valid
  /// until the next call.
  std::span<const AxisReport> run(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept;
  /// Ends the motion of the axis at once, because its last set-point did not reach the drive. The
  /// other axes of its group stop along their limits. The axis is not kept alive any longer.
  void abandon(std::uint8_t axis, StopCause cause) noexcept;
  /// Ends all motions at once.
  void abandon_all(StopCause cause) noexcept;
  /// Returns true if the drive of the axis has to stay enabled in a cycle without SYNC.
  bool outlives_gap(std::uint8_t axis, CycleNumber cycle) const noexcept;
  /// The reports of the last run.
  std::span<const AxisReport> reports() const noexcept { return reports_; }

  /// Number of points that wait in the streams of all axes. Each of them adds
  /// StreamPoint::kept_words to keep().
  std::size_t points() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(runners_, reports_, heard_);
    for (std::size_t i = 0; i < runners_.size(); ++i) state(stops_[i]);
  }

 private:
  /// A stop of those axes of a group whose newest motion has this id, or of all of its axes.
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
  std::array<GroupStop, max_axes> stops_{};    ///< of each group in the next cycle
  std::array<CycleNumber, max_axes> heard_{};  ///< of each sender
};

}  // namespace takt::motion
