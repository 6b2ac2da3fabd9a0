#pragma once
#include <cstdint>
#include <optional>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/motion_order.hpp"
#include "master/motion/beat/profile_player.hpp"

namespace takt::motion {

/// Runs the motions of one axis, cycle by cycle. Its states:
///
/// | from               | to        | when                                                    |
/// |--------------------|-----------|---------------------------------------------------------|
/// | unpowered          | standing  | the drive is enabled: it stands at its actual position  |
/// | standing, moving   | moving    | an order begins in its cycle                            |
/// | moving             | standing  | the motion has ended at rest                            |
/// | moving             | stopping  | stop()                                                  |
/// | stopping           | standing  | the axis is at rest                                     |
/// | each other         | unpowered | the drive is no longer enabled                          |
///
/// A cycle calls observe(), then stop() if the group stops, then begin() or refuse() if an order is
/// due, then run(). No call allocates; the bound of instructions is that of stop().
class AxisRunner {
 public:
  /// Difference of a start from the commanded state that counts as rounding, as a part of the limit
  /// of velocity and acceleration, and of the position or of 1 where the position is smaller.
  static constexpr double start_tolerance = 1e-9;

  explicit AxisRunner(double period) noexcept : period_{period} {}

  /// The order waits for its first cycle. It replaces another one that waits.
  void wait(const MotionOrder& order) noexcept;
  /// Returns the order that waits if its first cycle is this one or has passed.
  const MotionOrder* due(Cycle cycle) const noexcept;
  /// Returns Outcome::none if the order that is due may begin.
  Outcome objection(Cycle cycle) noexcept;
  void begin(Cycle cycle) noexcept;
  void refuse(Outcome why) noexcept;

  /// Takes what the drive tells. Returns the cause if the axis makes its group stop. `silence` is
  /// the number of cycles since the sender was heard.
  StopCause observe(Cycle cycle, const AxisInput& input, Cycle silence) noexcept;
  /// Starts the shortest stop from the commanded state of the cycle before. It also ends an order
  /// that waits. An axis that doesn't move keeps its state.
  void stop(Cycle cycle, const Stop& stop) noexcept;
  /// Gives the commanded state of the cycle.
  const AxisReport& run(Cycle cycle) noexcept;

  std::uint8_t group() const noexcept { return group_; }

 private:
  State commanded_at(Cycle cycle) noexcept;
  void end(Outcome outcome) noexcept;

  double period_;
  AxisReport report_;
  ProfilePlayer player_;
  Cycle began_ = 0;
  Limits stop_limits_;
  Cycle timeout_ = 0;
  Cycle latest_stop_ = 0;
  double max_following_error_ = 0.0;
  std::optional<MotionOrder> waiting_;
  std::uint8_t group_ = 0;
};

}  // namespace takt::motion
