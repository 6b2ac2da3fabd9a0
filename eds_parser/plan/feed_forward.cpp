#include <algorithm>

#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/table/motion_axes.hpp"

namespace takt {
namespace {

constexpr std::uint16_t torque_offset = 0x60B2;

bool has_feed_forward(const NodePlan& node, std::uint8_t number) {
  return std::ranges::any_of(
      node.axes, [&](const AxisPlan& axis) { return axis.number == number && axis.feed_forward; });
}

}  // namespace

void judge_feed_forward(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report) {
  for (const MotionAxis& axis : motion_axes(plan)) {
    const NodePlan& node = plan.nodes[axis.node_index];
    const auto source = std::ranges::find(spec.nodes, node.name, &NodeSpec::name);
    if (source == spec.nodes.end()) continue;
    const ObjectKey object = axis_object(axis.number, torque_offset);
    const auto signal = plan.layout.find(axis.node_index, object, true);
    if (!has_feed_forward(node, axis.number)) {
      if (!signal) continue;
      report.note(source->pos, "feed-forward", object, " (torque offset) of `", node.name,
                  "` is in an RPDO, but the motions of taktd do not command it: write "
                  "`feed_forward: {torque_per_acceleration: ...}`, or let the application command "
                  "it");
      continue;
    }
    if (!signal) {
      report.warning(source->feed_forward.pos, "feed-forward", "`feed_forward` of `", node.name,
                     "` has no effect: no RPDO contains ", object, " (torque offset)");
      continue;
    }
    const Signal& torque = plan.layout.signals[*signal];
    if (!torque.unit.empty() || torque.scale != 1.0 || source->units.has_errors) continue;
    report.error(source->feed_forward.pos, "feed-forward", "`feed_forward` of `", node.name,
                 "`: ", object,
                 " has no unit, so the torque would be in raw counts: write a unit under "
                 "`units:` (`torque: {scale: 1, unit: counts}` if counts are meant)");
  }
}

}  // namespace takt
