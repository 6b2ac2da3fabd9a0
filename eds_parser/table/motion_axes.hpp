#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// An axis whose motions the master can run: the signals that a motion reads and writes.
struct MotionAxis {
  std::uint8_t node_index = 0;               ///< position in BusPlan::nodes
  std::uint8_t number = 0;                   ///< axis number within its device, from 0
  SignalIndex statusword = 0;                ///< 6041
  SignalIndex position = 0;                  ///< 6064
  SignalIndex target = 0;                    ///< 607A
  std::optional<SignalIndex> controlword{};  ///< 6040
  std::optional<SignalIndex> velocity{};     ///< 606C
  std::optional<SignalIndex> mode{};         ///< 6061, else 6060 if it is an output
  /// 60B1, if its unit is that of the target per second.
  std::optional<SignalIndex> velocity_offset{};
  bool needs_homing = false;  ///< `homing:` of the network file requires it
  Time homing_timeout{};      ///< longest time of a homing run
};

/// Returns the CiA 402 axes that have a statusword (6041) and an actual position (6064) in TPDOs
/// and a target position (607A) in the same unit without an offset (60B0) in RPDOs, in the order of
/// the nodes. At most 127 are returned. Both sides of the master number the axes in this order.
std::vector<MotionAxis> motion_axes(const BusPlan& plan);

}  // namespace takt
