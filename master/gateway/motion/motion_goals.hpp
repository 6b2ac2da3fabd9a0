#pragma once
#include <expected>
#include <span>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>

#include "master/gateway/motion/axis_motion_limits.hpp"
#include "master/gateway/motion/motion_job.hpp"

namespace takt {

/// Returns true if a motion may have this `timeout_ms`.
bool is_motion_timeout(std::int32_t milliseconds) noexcept;
/// Returns the timeout of the message. A `timeout_ms` that is refused counts as the default one.
Time motion_timeout_of(const motion_command_t& command) noexcept;
/// Returns the number of periods that begin in this time, at least 1.
std::uint64_t cycles_in(Time span, Time period) noexcept;

/// Returns the message of a stream, without its points, as a command of the kind "stream". The
/// goals of the command are the positions of the first point.
motion_command_t command_of(const motion_stream_t& stream);
/// Returns the message of a gear as a command of the kind "gear" with the same goals.
motion_command_t command_of(const motion_gear_t& gear);

/// Turns a command into a job. The caller sets `until` and the number of the sender. `axes` are the
/// axes of the goals, as indices into motion_axes(); `period` is the period of the cycle.
std::expected<MotionJob, MotionRefusal> motion_job(const motion_command_t& command,
                                                   std::span<const std::size_t> axes,
                                                   const AxisMotionLimits& limits, Time period);

/// Turns the first message of a stream into a job, as motion_job() does. `command` is the command
/// of this message.
std::expected<MotionJob, MotionRefusal> stream_job(const motion_stream_t& stream,
                                                   const motion_command_t& command,
                                                   std::span<const std::size_t> axes,
                                                   const AxisMotionLimits& limits, Time period);

}  // namespace takt
