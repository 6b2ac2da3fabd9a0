#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
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

  /// Takes an order before its first cycle or in it. It counts as a message of the sender. Returns
  /// false if there is no such axis or group.
  bool take(const MotionOrder& order, Cycle cycle) noexcept;
  /// The sender of the motions of this group is alive in this cycle.
  void sender_heard(std::uint8_t group, Cycle cycle) noexcept { heard_[group] = cycle; }
  /// Stops each axis of the group along its own limits in the next run().
  void stop_group(std::uint8_t group, StopCause cause) noexcept;
  /// Does the same for all groups.
  void stop_all(StopCause cause) noexcept;

  /// Runs one cycle. `inputs` has one element for each axis, and so has the result, which is valid
  /// until the next call. Cycles must follow each other without a gap, from 1 on.
  std::span<const AxisReport> run(Cycle cycle, std::span<const AxisInput> inputs) noexcept;

 private:
  void observe(Cycle cycle, std::span<const AxisInput> inputs) noexcept;
  void stop_groups(Cycle cycle) noexcept;
  void begin_orders(Cycle cycle) noexcept;
  Outcome objection_of(std::size_t axis, Cycle cycle) noexcept;

  std::vector<AxisRunner> runners_;
  std::vector<AxisReport> reports_;
  std::array<Stop, max_axes> stops_{};   ///< of each group in the next cycle
  std::array<Cycle, max_axes> heard_{};  ///< of each group
  /// Orders of each group that may begin in this cycle.
  struct Ready {
    std::uint32_t id = 0;
    std::uint8_t orders = 0;
  };
  std::array<Ready, max_axes> ready_{};
};

}  // namespace takt::motion
