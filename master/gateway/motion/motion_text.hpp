#pragma once
#include <string_view>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/planner/motion_planner.hpp"
#include "master/motion/planner/stream_check.hpp"

namespace takt {

/// Returns the reason why there is no motion, as the end of a sentence: "the axis is stopping".
std::string_view text(const motion::PlanRefusal& refusal) noexcept;
/// Returns the reason why a point of a stream is refused.
std::string_view text(motion::StreamDefect defect) noexcept;
/// Returns the reason why an order did not begin.
std::string_view text(motion::Outcome outcome) noexcept;
/// Returns the reason why a group has stopped.
std::string_view text(motion::StopCause cause) noexcept;
/// Returns the reason why an absolute motion of an axis in this state is refused, and what to do.
std::string_view text(motion::HomingState homing) noexcept;

}  // namespace takt
