#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "master/motion/beat/gear_task.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Number of a cycle. Motions advance only in cycles whose SYNC was sent. The numbers follow the
/// clock: they jump over periods without SYNC, so that their differences are times. They never
/// wrap.
using CycleNumber = std::uint64_t;

/// Axes, groups and senders are numbered from 0. A bus has at most 127 nodes, and axes above this
/// number can't be moved.
inline constexpr std::size_t max_axes = 127;

/// The behaviour of an axis at the end of its motion.
enum class Ending : std::uint8_t {
  rest,    ///< the axis is at rest at the end position
  cruise,  ///< the axis keeps the velocity of the end until it is stopped (jog)
  points,  ///< the axis follows a stream of points instead of a profile, and ends with the last
           ///< point
  gear,    ///< the axis follows a leader instead of a profile, until it is stopped
};

/// The newest message of a sender: the cycle whose image the sender had seen.
struct LifeSign {
  std::uint8_t sender = max_axes;  ///< max_axes means no sender
  CycleNumber cycle = 0;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(cycle);
    state.position(sender, max_axes + 1);
  }
};

/// A planned motion of one axis, which the bus thread runs from one cycle on. All orders of a group
/// that have the same id begin together, or none does. Plain data.
struct MotionOrder {
  std::uint32_t id = 0;     ///< not 0
  std::uint8_t axis = 0;    ///< less than max_axes
  std::uint8_t group = 0;   ///< number of one axis of the group, which must have an order as well
  std::uint8_t axes = 1;    ///< number of orders with this id
  std::uint8_t sender = 0;  ///< less than max_axes
  Ending ending = Ending::rest;
  CycleNumber begin = 0;  ///< the motion begins in this cycle, in the state `from`
  /// Must be the commanded state of the axis in the cycle `begin`; not used with Ending::gear.
  State from;
  Profile profile;  ///< motion that starts at `from`; only for `rest` and `cruise`
  GearTask gear{};  ///< only for Ending::gear
  Limits stop;      ///< limits of a stop
  /// Number of periods for which the motion continues while its sender is silent.
  CycleNumber timeout = 0;
  /// The axis is stopped at the latest this number of cycles after `begin`, see cycles_with_stop().
  CycleNumber latest_stop = std::numeric_limits<CycleNumber>::max();
  /// Distance between commanded and actual position above which the group stops.
  double max_following_error = std::numeric_limits<double>::infinity();

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(id, axes, ending, begin, from, profile, gear, stop, timeout, latest_stop,
          max_following_error);
    state.position(axis, max_axes);
    state.position(group, max_axes);
    state.position(sender, max_axes);
  }
};

/// Returns true if all numbers of the order are finite where they must be, and the limits of its
/// stop permit a stop.
bool is_sound(const MotionOrder& order) noexcept;

}  // namespace takt::motion
