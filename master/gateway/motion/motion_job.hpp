#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/motion/beat/motion_message.hpp"
#include "master/motion/planner/motion_planner.hpp"

namespace takt {

/// Hands a message to the bus thread. Returns false if too many wait.
using SubmitMotion = std::function<bool(const motion::MotionMessage& message)>;

/// Identifies a motion in reports to users.
struct MotionName {
  std::int32_t id = 0;  ///< id that the application has chosen
  std::string sender{};
};

/// The reason why a motion is refused, and the axis that caused the refusal, as an index into
/// motion_axes().
struct MotionRefusal {
  std::string why{};
  std::optional<std::size_t> axis{};
};

/// A move, a jog, a gear or the start of a stream that the bus thread has not begun yet.
struct MotionJob {
  MotionName name{};
  std::int64_t instance = 0;  ///< instance of the sender
  Time until{};  ///< after this time, the job is refused unless its orders may still begin
  motion::GroupGoal group{};
  std::vector<motion::AxisGoal> goals{};
  std::vector<motion::GearTask> gears{};      ///< tasks of a gear, by goal; empty for other jobs
  std::vector<motion::MotionOrder> orders{};  ///< orders that are planned and not sent yet
  unsigned tries = 0;
  std::uint32_t order = 0;        ///< id of the orders; 0 while the job waits to be planned
  motion::CycleNumber begin = 0;  ///< first cycle of the orders
};

}  // namespace takt
