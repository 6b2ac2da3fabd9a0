#pragma once
#include <cstdint>

#include "master/motion/beat/motion_order.hpp"

namespace takt::motion {

/// What a drive tells in a cycle.
enum class AxisCondition : std::uint8_t {
  enabled,   ///< it follows set-points (CiA 402: Operation enabled)
  disabled,  ///< it does not, without a fault
  fault,
  lost,  ///< its node is not heard
};

struct AxisInput {
  AxisCondition condition = AxisCondition::disabled;
  State actual;
};

enum class AxisState : std::uint8_t { unpowered, standing, moving, stopping };

/// Why a group stops.
enum class StopCause : std::uint8_t {
  none,
  sender_silent,    ///< longer than the timeout of the motion
  disabled,         ///< an axis left Operation enabled
  fault,            ///< of an axis
  node_lost,        ///< of an axis
  following_error,  ///< of an axis, above its limit
  end_of_range,     ///< a later stop would leave the range of positions
  ordered_stop,     ///< of the master
  application,      ///< it asked for the stop
};

/// The last stop of a group since the motion of the axis began: why, and which axis was the cause.
struct Stop {
  StopCause cause = StopCause::none;
  std::uint8_t axis = 0;  ///< 0 where no axis is the cause
};

enum class Outcome : std::uint8_t {
  none,
  done,      ///< the axis stands at the end of the motion
  stopped,   ///< by a stop, see Stop
  replaced,  ///< by a later order
  // The others are refusals: the order did not begin.
  too_late,           ///< its first cycle had passed
  other_start,        ///< it does not begin where the axis is commanded to be
  no_rest,            ///< the end of its profile contradicts `ending`
  not_powered,        ///< the drive does not follow set-points
  is_stopping,        ///< the axis must come to rest first
  sender_was_silent,  ///< longer than the timeout, before its first cycle
  group_incomplete,   ///< an order of the group is missing, or was refused
};

/// How an order ended.
struct EndedOrder {
  std::uint32_t id = 0;
  Outcome outcome = Outcome::none;
};

/// What an axis does in a cycle.
struct AxisReport {
  AxisState state = AxisState::unpowered;
  State commanded;
  State actual;
  double following_error = 0.0;  ///< last commanded position minus actual position
  std::uint32_t running = 0;     ///< id of the motion of this cycle, 0 for none
  Cycle cycles_left = 0;         ///< until the end of the profile that runs
  EndedOrder ended;              ///< of the order that ended last
  Stop stop;
};

}  // namespace takt::motion
