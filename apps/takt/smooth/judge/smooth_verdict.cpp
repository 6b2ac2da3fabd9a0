#include "apps/takt/smooth/judge/smooth_verdict.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <utility>

#include "apps/takt/smooth/judge/judges.hpp"

namespace takt::smooth {
namespace {

using enum Cause;

bool has(const Findings& findings, Cause cause) {
  return std::ranges::find(findings, cause, &Finding::cause) != findings.end();
}

/// The findings that follow from a cause and are therefore left out.
struct Consequence {
  Cause cause{};
  std::initializer_list<Cause> follows{};
};

void leave_out_consequences(const Findings& of_bus, Findings& findings) {
  static const std::array<Consequence, 13> rules{{
      {two_sync_producers, {late, early, skipped, overwritten, clock_beat, actual_ripple}},
      {sync_missing, {skipped, overwritten, actual_ripple}},
      {sync_jitter, {late, early, clock_beat, actual_ripple}},
      {two_senders,
       {overwritten, skipped, late, early, clock_beat, duplicated, value_skipped, value_beat,
        slow_values, velocity_jump, set_point_ripple, coarse, feed_forward, actual_ripple}},
      {clock_beat,
       {skipped, overwritten, late, early, duplicated, value_skipped, value_beat, slow_values,
        set_point_ripple, velocity_jump, actual_ripple}},
      {slow_values,
       {duplicated, value_skipped, value_beat, velocity_jump, set_point_ripple, coarse,
        actual_ripple}},
      {duplicated, {value_skipped, velocity_jump}},
      {value_beat, {set_point_ripple, velocity_jump, actual_ripple}},
      {coarse, {duplicated, value_skipped, value_beat, set_point_ripple, actual_ripple}},
      {set_point_ripple, {duplicated, value_skipped, value_beat, actual_ripple}},
      {left_operation, {feed_forward, actual_ripple}},
      {mode_changed, {feed_forward, actual_ripple}},
      {interpolation_period, {actual_ripple}},
  }};
  Findings all = of_bus;
  all.insert(all.end(), findings.begin(), findings.end());
  for (const Consequence& rule : rules) {
    if (!has(all, rule.cause)) continue;
    std::erase_if(findings, [&](const Finding& finding) {
      return std::ranges::find(rule.follows, finding.cause) != rule.follows.end();
    });
  }
  // The drive counts as a cause only if its set-points do not explain the finding.
  const auto is_of_set_points = [](const Finding& finding) {
    return finding.cause >= two_senders && finding.cause <= coarse;
  };
  if (std::ranges::any_of(findings, is_of_set_points)) {
    std::erase_if(findings, [](const Finding& f) { return f.cause == actual_ripple; });
  }
}

AxisVerdict figures_of(const AxisView& view) {
  const AxisCycles& cycles = view.cycles;
  AxisVerdict out{.name = view.axis.name,
                  .node = view.axis.node,
                  .axis = view.axis.axis,
                  .set_point = view.axis.set_point,
                  .set_point_id = view.axis.set_point_id,
                  .set_points = view.axis.set_points.size(),
                  .cycles = cycles.cycles.size(),
                  .moving = cycles.moving,
                  .period = cycles.period,
                  .interpolation = view.axis.settings.interpolation.value_or(Time{})};
  for (const Cycle& cycle : cycles.cycles) {
    if (!cycle.moving || !cycle.whole) continue;
    if (cycle.count == 0) ++out.without;
    if (cycle.count > 1) ++out.with_two;
  }
  if (cycles.period > Time{}) out.peak_velocity = cycles.velocity(cycles.peak);
  return out;
}

bool has_error(const Findings& findings) {
  return std::ranges::find(findings, Gravity::error, &Finding::gravity) != findings.end();
}

}  // namespace

bool Verdict::rough() const {
  return has_error(findings) || std::ranges::any_of(axes, [](const AxisVerdict& axis) {
           return has_error(axis.findings);
         });
}

Verdict judge(const BusRecord& bus) {
  Verdict out{.source = bus.source,
              .length = bus.length,
              .sync = sync_grid(bus.syncs, bus.planned_period),
              .remarks = bus.remarks};
  std::vector<AxisCycles> cycles;
  for (const AxisRecord& axis : bus.axes) cycles.push_back(axis_cycles(axis, out.sync));
  std::vector<AxisView> views;
  for (std::size_t i = 0; i < bus.axes.size(); ++i) {
    views.push_back({bus, out.sync, bus.axes[i], cycles[i]});
  }
  judge_sync(bus, out.sync, out.findings);
  sort_findings(out.findings);
  std::vector<Findings> findings(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const auto judge_one :
         {judge_settings, judge_senders, judge_arrivals, judge_values, judge_shape, judge_drive}) {
      judge_one(views[i], findings[i]);
    }
  }
  judge_group(views, findings);
  for (std::size_t i = 0; i < views.size(); ++i) {
    leave_out_consequences(out.findings, findings[i]);
    sort_findings(findings[i]);
    out.axes.push_back(figures_of(views[i]));
    out.axes.back().findings = std::move(findings[i]);
  }
  return out;
}

}  // namespace takt::smooth
