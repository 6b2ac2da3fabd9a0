#include <string>
#include <string_view>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"

namespace takt {
namespace {

class BusText {
 public:
  BusText(PlanLines& lines, const BusPlan& plan, const RealtimeOptions& realtime)
      : lines_{lines}, plan_{plan}, realtime_{realtime} {}

  void bus() {
    lines_.line("bus {}: {} node{} at {} kbit/s, {}", plan_.name, plan_.nodes.size(),
                plan_.nodes.size() == 1 ? "" : "s", plan_.bitrate / 1000,
                plan_.interface.empty() ? "simulated (the file names no interface)"
                                        : "interface " + plan_.interface);
    lines_.line(
        "  master is node {}, {}; {}", plan_.master_id.value(),
        plan_.master_heartbeat == Time{} ? "without heartbeat"
                                         : "heartbeat every " + span_text(plan_.master_heartbeat),
        plan_.start_nodes ? "starts every node when its boot is done" : "does not start nodes");
    const RealtimeOptions& rt = realtime_;
    const std::string_view mode = rt.mode == RtMode::enforce ? "enforce"
                                  : rt.mode == RtMode::off   ? "off"
                                                             : "try";
    lines_.line("  real time: {}, SCHED_FIFO {}, {}, awake {} before SYNC", mode, rt.priority,
                rt.cpu ? fmt::format("cpu {}", *rt.cpu) : "any cpu", us_text(rt.spin));
    lines_.line("  ordered stop within {}", span_text(plan_.stop_timeout));
    const std::string start_up = start_up_text();
    if (!start_up.empty()) lines_.line("  {}", start_up);
  }

 private:
  /// Returns only the values that differ from the defaults.
  std::string start_up_text() const {
    const StartUpPlan& start = plan_.start_up;
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

  PlanLines& lines_;
  const BusPlan& plan_;
  const RealtimeOptions& realtime_;
};

}  // namespace

void add_bus(PlanLines& lines, const BusPlan& plan, const RealtimeOptions& realtime) {
  BusText{lines, plan, realtime}.bus();
}

}  // namespace takt
