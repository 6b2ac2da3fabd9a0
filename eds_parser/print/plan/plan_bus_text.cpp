#include <string>
#include <string_view>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

/// Returns only the values that differ from the defaults.
std::string start_up_text(const StartUpPlan& start) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!start.start_master) add("the master does not become operational by itself");
  if (start.start_all) add("all nodes are started by one broadcast");
  if (start.on_loss == MandatoryLoss::reset_all) add("loss of a mandatory node resets all nodes");
  if (start.on_loss == MandatoryLoss::stop_all) add("loss of a mandatory node stops all nodes");
  if (start.boot_time != Time{}) {
    add("mandatory nodes boot within " + span_text(start.boot_time));
  }
  if (start.nmt_inhibit != Time{}) {
    add("NMT commands at least " + span_text(start.nmt_inhibit) + " apart");
  }
  return text;
}

}  // namespace

void add_bus(PlanLines& lines, const BusPlan& plan, const RealtimeOptions& rt) {
  lines.line("bus {}: {} node{} at {} kbit/s, {}", plan.name, plan.nodes.size(),
             plan.nodes.size() == 1 ? "" : "s", plan.bitrate / 1000,
             plan.interface.empty() ? "simulated (the file names no interface)"
                                    : "interface " + plan.interface);
  lines.line("  master is node {}, {}; {}", plan.master_id.value(),
             plan.master_heartbeat == Time{}
                 ? "without heartbeat"
                 : "heartbeat every " + span_text(plan.master_heartbeat),
             plan.start_nodes ? "starts every node when its boot is done" : "does not start nodes");
  static constexpr std::string_view modes[]{"enforce", "try", "off"};
  lines.line("  real time: {}, SCHED_FIFO {}, {}, active wait of {} before SYNC",
             name_of(rt.mode, modes), rt.priority,
             rt.cpu ? fmt::format("cpu {}", *rt.cpu) : "any cpu", us_text(rt.spin));
  lines.line("  ordered stop within {}", span_text(plan.stop_timeout));
  const std::string start_up = start_up_text(plan.start_up);
  if (!start_up.empty()) lines.line("  {}", start_up);
}

}  // namespace takt
