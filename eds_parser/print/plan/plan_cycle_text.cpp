#include <algorithm>
#include <string>
#include <string_view>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

void add_time_of_day(PlanLines& lines, const TimePlan& time) {
  if (time.period == Time{}) return;
  lines.line("  TIME {} (time of day, UTC) at the start and every {} ms.", to_string(time.cob_id),
             time.period / 1ms);
}

std::string sync_producer_text(const BusPlan& plan) {
  if (!plan.cycle.sync_producer) return "a device outside of this file";
  const NodePlan* node = plan.find(plan.cycle.sync_producer->value());
  return node == nullptr ? "an unknown node" : "node " + node->name;
}

std::string_view sync_loss_text(SyncLoss reaction) noexcept {
  static constexpr std::string_view texts[]{
      "the master reports the loss and sends no outputs until SYNC is back",
      "the master reports the loss, and outputs take their fallback until SYNC is back",
      "the master reports the loss and stops all nodes but the producer until SYNC is back"};
  return name_of(reaction, texts);
}

}  // namespace

void add_cycle(PlanLines& lines, const BusPlan& plan) {
  const CyclePlan& c = plan.cycle;
  const TimeBudget budget = time_budget(plan);
  lines.line("");
  if (!c.sync) {
    lines.line("cycle: no SYNC; the image has a period of {}", us_text(c.period));
    lines.line(
        "  Outputs go out up to {} after the start of the period; up to {} service frames a "
        "cycle.",
        us_text(c.output_deadline), c.service_frames);
    add_time_of_day(lines, plan.time);
    return;
  }
  lines.line("cycle: {} (wire times with worst bit stuffing)", us_text(c.period));
  lines.line(
      "{:>9}  SYNC {}{}{}", "0 us", to_string(c.sync_cob_id),
      c.sync_overflow == 0 ? ", without counter" : fmt::format(", counter 1..{}", c.sync_overflow),
      c.sync_followed ? ", produced by " + sync_producer_text(plan) : "");
  lines.line("{:>9}  the last of {} synchronous TPDOs has arrived, if all devices answer at once",
             us_text(budget.earliest), std::ranges::count_if(plan.pdos.tpdos, &PdoRow::cyclic));
  lines.line("{:>9}  receive window ends: a TPDO that has not arrived counts as missing",
             us_text(c.receive_window));
  lines.line("{:>9}  outputs go out: {} RPDOs, {} on the wire", us_text(c.output_deadline),
             plan.pdos.rpdos.size(), us_text(budget.outputs_wire));
  lines.line("{:>9}  the master is quiet until SYNC", us_text(c.period - c.quiet_before_sync));
  if (budget.next_sync) {
    lines.line(
        "  Time of the application: sampled at SYNC k, computed between {} and {} us ({} us), "
        "acts at SYNC k+1.",
        budget.earliest / 1us, budget.latest / 1us, (budget.latest - budget.earliest) / 1us);
  } else {
    lines.line("  No time is left for the application: its output for SYNC k acts at SYNC k+2.");
  }
  lines.line("  Process data fill {:.0f} % of the bus; up to {} service frames (SDO, NMT) a cycle.",
             100.0 * static_cast<double>((budget.inputs_wire + budget.outputs_wire).count()) /
                 static_cast<double>(c.period.count()),
             c.service_frames);
  if (c.sync_window != Time{})
    lines.line("  Synchronous window (1007): {}.", us_text(c.sync_window));
  add_time_of_day(lines, plan.time);
  if (c.sync_followed) {
    lines.line("  The cycle follows this SYNC, which may be {} early. After {} without SYNC: {}.",
               us_text(c.followed_tolerance()), us_text(c.sync_timeout),
               sync_loss_text(c.on_sync_loss));
  }
}

}  // namespace takt
