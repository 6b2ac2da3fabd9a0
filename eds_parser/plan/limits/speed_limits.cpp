#include "eds_parser/plan/limits/speed_limits.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "eds_parser/table/output_limits.hpp"

namespace takt {
namespace {

template <class T>
void refuse(const NodeSpec& node, LimitKind kind, const Sourced<T>& limit, NetworkReport& report) {
  if (!limit.given) return;
  report.error(
      limit.pos, "limits", "`", name(kind), "` in `limits` of node `", node.name,
      "`: a speed axis has no position, so only `velocity` and `acceleration` apply to it");
}

void add_line(const SpeedAxisPlan& axis, LimitKind kind, double high, std::string unit,
              BusPlan& plan) {
  plan.limits.lines.push_back({.node_index = axis.node_index,
                               .axis = 1,
                               .kind = kind,
                               .source = LimitSource::file,
                               .high = high,
                               .unit = std::move(unit),
                               .signals = {axis.set_speed}});
}

}  // namespace

void compile_speed_limits(const NodeSpec& node, SpeedAxisPlan& axis, BusPlan& plan,
                          LimitTable& table, NetworkReport& report) {
  const AxisLimitsSpec& limits = node.limits.all;
  refuse(node, LimitKind::position, limits.position, report);
  refuse(node, LimitKind::jerk, limits.jerk, report);
  refuse(node, LimitKind::step, limits.step, report);
  refuse(node, LimitKind::torque, limits.torque, report);
  refuse(node, LimitKind::following_error, limits.following_error, report);
  if (!limits.velocity.given && !limits.acceleration.given) return;
  const double count = std::abs(axis.set_scale);
  if (limits.velocity.given) {
    axis.max_speed = *limits.velocity;
    const double raw = std::floor(axis.max_speed / count * (1 + 1e-9));
    table.narrow(axis.set_speed, {-raw, raw}, LimitKind::velocity, limits.velocity.pos);
    add_line(axis, LimitKind::velocity, axis.max_speed, axis.unit, plan);
  }
  OutputLimit& row = table.row(axis.set_speed);
  row.range = LimitKind::velocity;
  if (limits.acceleration.given) {
    axis.max_acceleration = *limits.acceleration;
    row.rate =
        axis.max_acceleration / count * std::chrono::duration<double>(plan.cycle.period).count();
    row.rate_of = LimitKind::acceleration;
    add_line(axis, LimitKind::acceleration, axis.max_acceleration,
             axis.unit.empty() ? "" : axis.unit + "/s", plan);
  }
  row.quantity = AxisQuantity::velocity;
  row.controlword = axis.control;
  row.orders = orders_of(axis);
}

}  // namespace takt
