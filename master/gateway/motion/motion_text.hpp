#pragma once
#include <string_view>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/planner/motion_planner.hpp"
#include "master/motion/planner/stream_check.hpp"

namespace takt {

/// Why there is no motion, as the end of a sentence: "the axis is stopping".
std::string_view text(const motion::PlanRefusal& refusal) noexcept;
/// Why a point of a stream is refused.
std::string_view text(motion::StreamDefect defect) noexcept;
/// Why an order did not begin.
std::string_view text(motion::Outcome outcome) noexcept;
/// Why a group has stopped.
std::string_view text(motion::StopCause cause) noexcept;
/// Why an absolute motion of an axis in this state is refused, and what to do.
std::string_view text(motion::HomingState homing) noexcept;

}  // namespace takt
