#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The positions of a rotary axis, which begin again after a turn. All values are in counts of the
/// target position.
struct Turn {
  double length = 0.0;  ///< 0: the axis is not rotary, or its range keeps it from turning
  double lowest = 0.0;  ///< position at which a turn begins

  /// Returns the position inside the turn at which the axis is in the same place as at `counts`.
  double inside(double counts) const noexcept {
    return length > 0.0 ? counts - length * std::floor((counts - lowest) / length) : counts;
  }
  /// Returns the position nearest to `reference` at which the axis is in the same place as at
  /// `counts`. If two positions are half a turn away, returns the upper one.
  double nearest(double counts, double reference) const noexcept {
    return length > 0.0 ? counts + length * std::floor((reference - counts) / length + 0.5)
                        : counts;
  }
  /// Returns this turn for positions that are counts x scale + offset.
  Turn in_unit(double scale, double offset) const noexcept {
    const double begin = scale < 0.0 ? lowest + length : lowest;
    return {.length = length * std::abs(scale), .lowest = begin * scale + offset};
  }
};

/// Mode of operation (0x6060) in which a drive follows the set-points of motions. CiA 402-2.
enum class MotionMode : std::uint8_t {
  interpolated_position = 7,       ///< the drive takes points from 60C1:01
  cyclic_synchronous_position = 8  ///< the drive follows 607A
};

/// An axis whose motions the master can run: the signals that a motion reads and writes.
struct MotionAxis {
  std::uint8_t node_index = 0;               ///< position in BusPlan::nodes
  std::uint8_t number = 0;                   ///< axis number within its device, from 0
  SignalIndex statusword = 0;                ///< 6041
  SignalIndex position = 0;                  ///< 6064
  SignalIndex target = 0;                    ///< 607A, or 60C1:01 if `mode_of_motions` is 7
  std::optional<SignalIndex> controlword{};  ///< 6040
  std::optional<SignalIndex> velocity{};     ///< 606C
  std::optional<SignalIndex> mode{};         ///< 6061, else 6060 if it is an output
  MotionMode mode_of_motions = MotionMode::cyclic_synchronous_position;
  /// 60B1, if its unit is that of the target per second.
  std::optional<SignalIndex> velocity_offset{};
  /// 60B2, if the network file has a feed-forward of torque.
  std::optional<SignalIndex> torque_offset{};
  FeedForwardPlan feed_forward{};
  Turn turn{};                ///< turn of the target and of the position
  bool needs_homing = false;  ///< `homing:` of the network file requires it
  Time homing_timeout{};      ///< longest time of a homing run
};

/// Returns the CiA 402 axes for motions, in the order of the nodes. Such an axis has a statusword
/// (6041) and an actual position (6064) in TPDOs, and a target position in an RPDO. Both positions
/// have the same unit. The target is 607A; without it, it is the first interpolation data record
/// (60C1:01). An axis with a position offset (60B0) in an RPDO is left out. At most 127 axes are
/// returned. The bus thread and the front thread number the axes in this order.
std::vector<MotionAxis> motion_axes(const BusPlan& plan);

}  // namespace takt
