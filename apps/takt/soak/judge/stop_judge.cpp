#include "apps/takt/soak/judge/stop_judge.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "apps/takt/soak/evidence/true_axes.hpp"

namespace takt::soak {

StopJudge::StopJudge(const BusPlan& plan, sim::World& world, Verdict& verdict)
    : world_{world}, verdict_{verdict} {
  for (const NodePlan& node : plan.nodes) {
    if (!node.cia402 || !node.boot) continue;
    for (const AxisPlan& axis : node.axes) axes_.push_back({.node = &node, .plan = &axis});
  }
}

void StopJudge::begin() {
  begun_ = true;
  look();
}

void StopJudge::look() {
  if (!begun_) return;
  for (Axis& axis : axes_) {
    const TrueAxis now = true_axis(world_, axis.node->id, axis.plan->number);
    const bool powered = now.powered();
    if (axis.powered && !powered) axis.speed_then = std::abs(now.velocity);
    axis.powered = powered;
    axis.was_powered |= powered;
  }
}

void StopJudge::hear(const Event& event) {
  if (event.kind != EventKind::axis_not_stopped) return;
  for (Axis& axis : axes_) {
    if (axis.node->id.value() != event.node) continue;
    axis.blamed |= axis.plan->number == (event.detail >> 8U & 0xFFU);
  }
}

void StopJudge::judge(StopResult result) {
  const bool any = std::ranges::any_of(axes_, &Axis::blamed);
  if (any && result == StopResult::confirmed) {
    verdict_.report_violation("no stop confirms more than was seen",
                              "the stop is confirmed, but an axis is reported as not stopped");
  }
  for (const Axis& axis : axes_) {
    if (axis.blamed || !axis.was_powered) continue;
    ++confirmed_;
    // Twice the window allows for rounding and for a motor that coasts between two checks.
    const bool moved = axis.speed_then > 2 * axis.plan->velocity_window;
    if (!moved && !axis.powered) continue;
    verdict_.report_violation(
        "no stop confirms more than was seen",
        axis.node->name + (axis.powered ? " is confirmed, but its power stage is on"
                                        : " is confirmed, but was disabled at " +
                                              std::to_string(axis.speed_then) + " counts/s"));
  }
}

}  // namespace takt::soak
