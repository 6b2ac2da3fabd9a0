#include <algorithm>
#include <string>
#include <string_view>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"

namespace takt {
namespace {

std::int64_t us(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time).count();
}

class CycleText {
 public:
  CycleText(PlanLines& lines, const BusPlan& plan) : lines_{lines}, plan_{plan} {}

  void cycle() {
    const CyclePlan& c = plan_.cycle;
    const TimeBudget budget = time_budget(plan_);
    lines_.line("");
    if (!c.sync) {
      lines_.line("cycle: no SYNC; the image has a period of {}", us_text(c.period));
      lines_.line(
          "  Outputs go out up to {} after the start of the period; up to {} service frames a "
          "cycle.",
          us_text(c.output_deadline), c.service_frames);
      time_of_day();
      return;
    }
    lines_.line("cycle: {} (wire times with worst bit stuffing)", us_text(c.period));
    lines_.line("{:>9}  SYNC {}{}{}", "0 us", to_string(c.sync_cob_id),
                c.sync_overflow == 0 ? ", without counter"
                                     : fmt::format(", counter 1..{}", c.sync_overflow),
                c.sync_followed ? ", made by " + sync_maker() : "");
    lines_.line(
        "{:>9}  the last of {} synchronous TPDOs has arrived, if all devices answer at once",
        us_text(budget.earliest), cyclic_inputs());
    lines_.line("{:>9}  receive window ends: a TPDO that has not arrived counts as missing",
                us_text(c.receive_window));
    lines_.line("{:>9}  outputs go out: {} RPDOs, {} on the wire", us_text(c.output_deadline),
                plan_.pdos.rpdos.size(), us_text(budget.outputs_wire));
    lines_.line("{:>9}  the master is quiet until SYNC", us_text(c.period - c.quiet_before_sync));
    if (budget.next_sync) {
      lines_.line(
          "  Time of the application: sampled at SYNC k, computed between {} and {} us ({} us), "
          "acts at SYNC k+1.",
          us(budget.earliest), us(budget.latest), us(budget.latest - budget.earliest));
    } else {
      lines_.line("  No time is left for the application: its output for SYNC k acts at SYNC k+2.");
    }
    lines_.line(
        "  Process data fill {:.0f} % of the bus; up to {} service frames (SDO, NMT) a cycle.",
        100.0 * static_cast<double>((budget.inputs_wire + budget.outputs_wire).count()) /
            static_cast<double>(c.period.count()),
        c.service_frames);
    if (c.sync_window != Time{})
      lines_.line("  Synchronous window (1007): {}.", us_text(c.sync_window));
    time_of_day();
    if (c.sync_followed) {
      lines_.line(
          "  The cycle follows this SYNC, which may be {} early. After {} without SYNC: {}.",
          us_text(c.followed_tolerance()), us_text(c.sync_timeout), sync_loss_text());
    }
  }

 private:
  void time_of_day() {
    const TimePlan& time = plan_.time;
    if (time.period == Time{}) return;
    lines_.line("  TIME {} (time of day, UTC) at the start and every {} ms.",
                to_string(time.cob_id), time.period / std::chrono::milliseconds{1});
  }

  std::string sync_maker() const {
    if (!plan_.cycle.sync_producer) return "a device outside of this file";
    const auto found = std::ranges::find(plan_.nodes, *plan_.cycle.sync_producer, &NodePlan::id);
    return found == plan_.nodes.end() ? "an unknown node" : "node " + found->name;
  }

  std::string_view sync_loss_text() const noexcept {
    switch (plan_.cycle.on_sync_loss) {
      case SyncLoss::hold:
        return "the master reports the loss and sends no outputs until SYNC is back";
      case SyncLoss::fallback:
        return "the master reports the loss, and outputs take their fallback until SYNC is back";
      case SyncLoss::stop:
        return "the master reports the loss and stops all nodes but the producer until SYNC is "
               "back";
    }
    return {};
  }

  std::size_t cyclic_inputs() const {
    return static_cast<std::size_t>(std::ranges::count_if(plan_.pdos.tpdos, &PdoRow::cyclic));
  }

  PlanLines& lines_;
  const BusPlan& plan_;
};

}  // namespace

void add_cycle(PlanLines& lines, const BusPlan& plan) { CycleText{lines, plan}.cycle(); }

}  // namespace takt
