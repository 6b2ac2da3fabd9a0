#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/motion/beat/motion_message.hpp"
#include "master/motion/planner/motion_planner.hpp"

namespace takt {

/// Hands a message to the bus thread. Returns false if too many wait.
using SubmitMotion = std::function<bool(const motion::MotionMessage& message)>;

/// A motion as people know it.
struct MotionName {
  std::int32_t id = 0;  ///< of the application
  std::string sender{};
};

/// Why a motion is refused, and the axis that it concerns, as a position in motion_axes().
struct MotionRefusal {
  std::string why{};
  std::optional<std::size_t> axis{};
};

/// A move, a jog or a gear on its way to the bus thread.
struct MotionJob {
  MotionName name{};
  std::int64_t instance = 0;  ///< of its sender
  Time until{};               ///< it is refused if it has no orders by then
  motion::GroupGoal group{};
  std::vector<motion::AxisGoal> goals{};
  std::vector<motion::GearTask> gears{};      ///< of a gear: one for each goal; else empty
  std::vector<motion::MotionOrder> orders{};  ///< planned, and not sent yet
  unsigned tries = 0;
  std::uint32_t order = 0;        ///< id of its orders; 0 while it waits to be planned
  motion::CycleNumber begin = 0;  ///< of its orders
};

}  // namespace takt
