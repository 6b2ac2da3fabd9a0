#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "master/motion/limits.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Number of a cycle of the bus thread. It never wraps.
using Cycle = std::uint64_t;

/// Axes and groups are numbered from 0; there is never more than one axis for each node.
inline constexpr std::size_t max_axes = 127;

/// What an axis does when its motion has come to its end.
enum class Ending : std::uint8_t {
  rest,    ///< it stands at the end position
  cruise,  ///< it keeps the velocity of the end until it is stopped (jog)
};

/// A planned motion of one axis, which the bus thread runs from one cycle on. All orders of a group
/// that have the same id begin together, or none does. Plain data.
struct MotionOrder {
  std::uint32_t id = 0;
  std::uint8_t axis = 0;   ///< less than max_axes
  std::uint8_t group = 0;  ///< less than max_axes; axes of one group stop together
  std::uint8_t axes = 1;   ///< number of orders with this id
  Ending ending = Ending::rest;
  Cycle begin = 0;    ///< the axis is at `from` in this cycle
  State from;         ///< must be what the axis is commanded in the cycle `begin`
  Profile profile;    ///< of the motion that starts at `from`
  Limits stop;        ///< of a stop, see defect_of()
  Cycle timeout = 0;  ///< cycles for which the motion outlives the silence of its sender
  /// The axis is stopped at the latest from the state that it has so many cycles after `begin`, see
  /// cycles_with_stop().
  Cycle latest_stop = std::numeric_limits<Cycle>::max();
  /// Distance between commanded and actual position above which the group stops.
  double max_following_error = std::numeric_limits<double>::infinity();
};

}  // namespace takt::motion
