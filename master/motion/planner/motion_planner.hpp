#pragma once
#include <cmath>
#include <cstdint>
#include <expected>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/motion_order.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::motion {

/// The goal of one axis, as an application commands it.
struct AxisGoal {
  std::uint8_t axis = 0;
  /// Move: the target position. Jog: only the velocity is used. Stream: the state in which it
  /// begins.
  State to;
  Limits limits;
  PositionRange range{};
  double turn = 0.0;  ///< length of a turn of a rotary axis, which moves to the nearest place of
                      ///< its target; 0 means not rotary
  /// Distance between commanded and actual position above which the group stops.
  double max_following_error = std::numeric_limits<double>::infinity();
};

/// Returns the length of the whole turns between the target of a rotary axis and the place of the
/// target that is nearest to `position`. If two places are half a turn away, the upper one counts.
inline double turns_to(const AxisGoal& goal, double position) noexcept {
  if (goal.turn <= 0.0) return 0.0;
  return goal.turn * std::floor((position - goal.to.position) / goal.turn + 0.5);
}

/// Identifies the motion of an order, in the numbers of the caller.
struct MotionTag {
  std::int32_t id = 0;
  std::int64_t instance = 0;
};

/// The zero of the target positions of a move.
enum class Reference : std::uint8_t {
  origin,
  commanded,  ///< the commanded position of the axis in the first cycle of the motion
};

/// The goal of a group of axes that begin and stop together.
struct GroupGoal {
  Goal goal = Goal::position;  ///< `velocity` means a jog
  Synchronisation synchronisation = Synchronisation::time;
  Reference reference = Reference::origin;  ///< zero of the positions of a move
  std::uint8_t sender = 0;
  /// Number of periods for which the motion continues while its sender is silent.
  CycleNumber timeout = 0;
  MotionTag tag{};
};

/// A planned order, and the motion to which it belongs.
struct TaggedOrder {
  MotionOrder order;
  MotionTag tag;
};

/// The reason why a motion can't be planned.
enum class PlanFault : std::uint8_t {
  no_axis,      ///< there is no such axis, or it is named twice
  no_report,    ///< the bus thread has not reported yet
  busy,         ///< another order of the axis is about to begin: plan again after the next report
  not_enabled,  ///< the drive does not follow set-points
  stopping,     ///< the axis must come to rest first
  foreign,      ///< the axis runs a motion that this planner does not know
  streaming,    ///< the axis follows a stream, and must be stopped first
  geared,       ///< the axis follows a gear: release it, and plan again after the next report
  moving,       ///< the axis must be at rest before it follows a stream
  ring,         ///< the leader of the gear follows this axis, perhaps through other axes
  other_start,  ///< the stream does not begin at rest at the position of the axis
  impossible,   ///< the motion is impossible; `defect` gives the reason
  too_long,     ///< the motion, or the start of a jog, takes too many cycles
};

struct PlanRefusal {
  PlanFault fault{};
  std::uint8_t axis = 0;
  Defect defect{};  ///< valid for PlanFault::impossible
};

/// Plans motions from the states that the axes will have in a future cycle. It knows these states
/// from the newest reports and from the orders that it has planned before. All calls come from one
/// thread.
class MotionPlanner {
 public:
  /// Largest number of cycles in which the axes of a jog reach their velocities, as the sum over
  /// all axes. It limits the time that plan() takes.
  static constexpr double longest_jog_start = 20'000;
  static constexpr double longest_motion = 1e9;  ///< duration in cycles
  /// Largest difference between the first point of a stream and the state of the axis that counts
  /// as rounding. It is relative to the position (at least 1) and to the limits.
  static constexpr double start_tolerance = 1e-6;

  /// `period` is the period of the cycle in s.
  MotionPlanner(std::size_t axes, double period) : period_{period}, axes_(axes) {}

  /// Takes the reports of all axes in this cycle.
  void observe(CycleNumber cycle, std::span<const AxisReport> reports);
  CycleNumber cycle() const noexcept { return cycle_; }
  /// Returns the order of the axis with this id. Returns nullptr if the order is unknown, or older
  /// than the order that runs. The result is valid until the next call of observe() or plan().
  const TaggedOrder* order(std::size_t axis, std::uint32_t id) const noexcept {
    return axes_[axis].find(id);
  }

  /// Plans a motion that begins in the cycle `begin`, which must be later than the next cycle. If
  /// an order of one of the axes waits, the new motion begins in the cycle of that order instead
  /// and replaces it. All orders have the same new id. The result is valid until the next call.
  std::expected<std::span<const MotionOrder>, PlanRefusal> plan(const GroupGoal& group,
                                                                std::span<const AxisGoal> goals,
                                                                CycleNumber begin);
  /// Makes the orders of a stream of points, which begins in the cycle `begin` at the positions of
  /// the axes. The orders contain no motion: the points follow.
  std::expected<std::span<const MotionOrder>, PlanRefusal> begin_stream(
      const GroupGoal& group, std::span<const AxisGoal> goals, CycleNumber begin);
  /// Makes the orders of a gear, which begins in the cycle `begin` in any state of the axes.
  /// `tasks` has one element for each goal.
  std::expected<std::span<const MotionOrder>, PlanRefusal> begin_gear(
      const GroupGoal& group, std::span<const AxisGoal> goals, std::span<const GearTask> tasks,
      CycleNumber begin);

 private:
  struct Axis {
    static constexpr std::size_t most_sent = 6;

    /// Returns the order that begins after the newest report; nullptr if there is none.
    const MotionOrder* waiting(CycleNumber cycle) const noexcept;
    const TaggedOrder* find(std::uint32_t id) const noexcept;

    AxisReport report;
    std::vector<TaggedOrder> sent;  ///< the order that runs, and those that may begin
  };

  State released_at(const AxisReport& report, const Limits& limits, CycleNumber cycle) const;
  std::expected<State, PlanFault> state_at(const Axis& axis, CycleNumber cycle) const;
  std::expected<CycleNumber, PlanRefusal> begin_of(std::span<const AxisGoal> goals,
                                                   CycleNumber begin) const;
  std::expected<void, PlanRefusal> set_tasks(const GroupGoal& group,
                                             std::span<const AxisGoal> goals, CycleNumber begin);
  std::optional<std::uint8_t> leader_of(std::uint8_t axis) const noexcept;
  std::optional<std::uint8_t> axis_that_leads(std::uint8_t leader,
                                              std::span<const AxisGoal> goals) const noexcept;
  std::span<const MotionOrder> number_orders(const MotionTag& tag);
  std::expected<void, PlanRefusal> set_orders(const GroupGoal& group,
                                              std::span<const AxisGoal> goals, CycleNumber begin);

  double period_;
  CycleNumber cycle_ = 0;
  std::uint32_t id_ = 0;
  std::vector<Axis> axes_;
  std::vector<AxisTask> tasks_;
  std::vector<PlannedAxis> planned_;
  std::vector<MotionOrder> orders_;
};

}  // namespace takt::motion
