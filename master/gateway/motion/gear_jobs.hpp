#pragma once
#include <cstddef>
#include <expected>
#include <span>
#include <takt/motion_gear_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/motion/axis_motion_limits.hpp"
#include "master/gateway/motion/motion_job.hpp"
#include "master/motion/beat/gear_task.hpp"

namespace takt {

/// The knowledge of the front thread about the axes of a bus.
struct KnownAxes {
  const BusPlan& plan;
  const std::vector<MotionAxis>& axes;  ///< motion_axes() of the plan
  const AxisMotionLimits& limits;
};

/// Turns the leader, the ratios and the phase of a gear into a task for each of its axes. The error
/// says why the gear is refused. `axes` are the axes of its goals, as indices into motion_axes(). A
/// measured leader is two cycles older than the effect of a set-point: the SYNC of a cycle samples
/// its position, and the axis reaches a set-point of this cycle two SYNCs later.
std::expected<std::vector<motion::GearTask>, MotionRefusal> gear_tasks(
    const motion_gear_t& gear, std::span<const std::size_t> axes, const KnownAxes& known);

}  // namespace takt
