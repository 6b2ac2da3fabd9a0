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

/// What the front thread knows of the axes of a bus.
struct KnownAxes {
  const BusPlan& plan;
  const std::vector<MotionAxis>& axes;  ///< motion_axes() of the plan
  const AxisMotionLimits& limits;
};

/// Turns the leader, the ratios and the phase of a gear into a task for each of its axes, or says
/// why it is refused. `axes` are those of its goals, as positions in motion_axes(). A measured
/// leader is two cycles older than the effect of a set-point: its position is sampled by the SYNC
/// of the cycle, and a set-point of the cycle is reached two SYNCs later.
std::expected<std::vector<motion::GearTask>, MotionRefusal> gear_tasks(
    const motion_gear_t& gear, std::span<const std::size_t> axes, const KnownAxes& known);

}  // namespace takt
