#include "eds_parser/table/motion_axes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace takt {
namespace {

constexpr std::size_t most_motion_axes = 127;

/// Returns true if both signals have the same unit. A motion reads the actual position from the
/// first signal and writes its target positions to the second one.
bool have_same_unit(const Signal& position, const Signal& target) {
  return position.scale == target.scale && position.offset == target.offset &&
         position.unit == target.unit;
}

/// Returns the turn of a rotary axis. If the permitted range of positions is shorter than a turn,
/// the axis can't make a turn and counts as not rotary.
Turn turn_of(const BusPlan& plan, SignalIndex target) {
  const auto row = std::ranges::find(plan.limits.outputs, target, &OutputLimit::signal);
  if (row == plan.limits.outputs.end() || !(row->modulus > 0.0 && row->modulus <= 0x1p32))
    return {};
  if (row->high - row->low < row->modulus - 1.0) return {};
  return {.length = std::round(row->modulus), .lowest = row->lowest};
}

/// Returns the axis of the node, or an axis with default values if the node has none of this
/// number.
AxisPlan axis_plan_of(const NodePlan& node, std::uint8_t number) {
  const auto found = std::ranges::find(node.axes, number, &AxisPlan::number);
  return found == node.axes.end() ? AxisPlan{} : *found;
}

std::optional<MotionAxis> motion_axis(const BusPlan& plan, std::uint8_t node, std::uint8_t number) {
  const auto find = [&](std::uint16_t index, bool output, std::uint8_t sub = 0) {
    return plan.layout.find(node, axis_object(number, index, sub), output);
  };
  const auto statusword = find(0x6041, false);
  const auto position = find(0x6064, false);
  const auto cyclic = find(0x607A, true);
  const auto target = cyclic ? cyclic : find(0x60C1, true, 1);
  if (!statusword || !position || !target || find(0x60B0, true)) return std::nullopt;
  const auto signal = [&](SignalIndex index) -> const Signal& {
    return plan.layout.signals[index];
  };
  if (!have_same_unit(signal(*position), signal(*target))) return std::nullopt;
  if (signal(*target).row >= plan.pdos.rpdos.size()) return std::nullopt;  // in no RPDO
  const auto offset = find(0x60B1, true);
  const bool same_unit = offset && !signal(*offset).unit.empty() &&
                         signal(*offset).unit == signal(*target).unit + "/s";
  const auto shown_mode = find(0x6061, false);
  const AxisPlan known = axis_plan_of(plan.nodes[node], number);
  const HomingPlan homing = known.homing.value_or(HomingPlan{.required = false});
  return MotionAxis{.node_index = node,
                    .number = number,
                    .statusword = *statusword,
                    .position = *position,
                    .target = *target,
                    .controlword = find(0x6040, true),
                    .velocity = find(0x606C, false),
                    .mode = shown_mode ? shown_mode : find(0x6060, true),
                    .mode_of_motions = cyclic ? MotionMode::cyclic_synchronous_position
                                              : MotionMode::interpolated_position,
                    .velocity_offset = same_unit ? offset : std::nullopt,
                    .torque_offset = known.feed_forward ? find(0x60B2, true) : std::nullopt,
                    .feed_forward = known.feed_forward.value_or(FeedForwardPlan{}),
                    .turn = turn_of(plan, *target),
                    .needs_homing = homing.required,
                    .homing_timeout = homing.timeout};
}

}  // namespace

std::vector<MotionAxis> motion_axes(const BusPlan& plan) {
  std::vector<MotionAxis> axes;
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    if (!plan.nodes[node].cia402) continue;
    for (std::uint8_t number = 0; number < most_axes; ++number) {
      const auto axis = motion_axis(plan, static_cast<std::uint8_t>(node), number);
      if (axis && axes.size() < most_motion_axes) axes.push_back(*axis);
    }
  }
  return axes;
}

}  // namespace takt
