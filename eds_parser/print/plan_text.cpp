#include <algorithm>
#include <fmt/format.h>
#include <ostream>

#include "eds_parser/cycle_compiler.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/plan.hpp"
#include "eds_parser/print/plan_names.hpp"

namespace takt {
namespace {

std::int64_t us(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time).count();
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string bits_text(const Signal& signal) {
  return signal.type == DataType::unknown ? fmt::format("{} bits", signal.bits)
                                          : std::string{name(signal.type)};
}

/// Which steps stand inside a `compare ... skip if same ... target` group, for the indentation.
std::vector<bool> skippable(const BootPlan& boot) {
  std::vector<bool> inside(boot.steps.size(), false);
  for (std::size_t i = 0; i < boot.steps.size(); ++i) {
    if (boot.steps[i].action != BootAction::skip_if_same) continue;
    for (std::size_t k = i + 1; k < boot.steps[i].target && k < inside.size(); ++k) {
      inside[k] = true;
    }
  }
  return inside;
}

class PlanText {
 public:
  PlanText(std::ostream& out, const BusPlan& plan, const PlanPrint& what)
      : out_{out}, plan_{plan}, what_{what} {}

  void run() {
    if (!what_.node) {
      bus();
      cycle();
    }
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      if (wanted(plan_.nodes[i].id)) node(i);
    }
    image();
    if (!what_.node) lcm();
    for (const NodePlan& node : plan_.nodes) {
      if (wanted(node.id)) boot(node);
    }
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    std::string text = fmt::format(format, std::forward<T>(values)...);
    while (!text.empty() && text.back() == ' ') text.pop_back();
    out_ << text << '\n';
  }
  bool wanted(NodeId id) const { return !what_.node || *what_.node == id; }

  void bus() {
    line("bus {}: {} node{} at {} kbit/s, {}", plan_.name, plan_.nodes.size(),
         plan_.nodes.size() == 1 ? "" : "s", plan_.bitrate / 1000,
         plan_.interface.empty() ? "simulated (the file names no interface)"
                                 : "interface " + plan_.interface);
    line("  master is node {}, {}; {}", plan_.master_id.value(),
         plan_.master_heartbeat == Time{} ? "without heartbeat"
                                          : "heartbeat every " + span_text(plan_.master_heartbeat),
         plan_.start_nodes ? "starts every node when its boot is done" : "does not start nodes");
    const RealtimeOptions& rt = what_.realtime;
    const std::string_view mode = rt.mode == RtMode::enforce ? "enforce"
                                  : rt.mode == RtMode::off   ? "off"
                                                             : "try";
    line("  real time: {}, SCHED_FIFO {}, {}, awake {} before SYNC", mode, rt.priority,
         rt.cpu ? fmt::format("cpu {}", *rt.cpu) : "any cpu", us_text(rt.spin));
    line("  ordered stop within {}", span_text(plan_.stop_timeout));
    const std::string start_up = start_up_text();
    if (!start_up.empty()) line("  {}", start_up);
  }

  /// Only what is not the default.
  std::string start_up_text() const {
    const StartUpPlan& start = plan_.start_up;
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (!start.start_master) add("the master does not become operational by itself");
    if (start.start_all) add("all nodes are started by one broadcast");
    if (start.on_loss == MandatoryLoss::reset_all) add("loss of a mandatory node resets all");
    if (start.on_loss == MandatoryLoss::stop_all) add("loss of a mandatory node stops all");
    if (start.boot_time != Time{}) {
      add("mandatory nodes boot within " + span_text(start.boot_time));
    }
    if (start.nmt_inhibit != Time{}) {
      add("NMT commands at least " + span_text(start.nmt_inhibit) + " apart");
    }
    return text;
  }

  std::string reaction_text(const NodePlan& node) const {
    const std::string group = node.group == 0 ? "" : plan_.groups[node.group - 1U];
    switch (node.on_loss) {
      case LossReaction::report:
        return {};
      case LossReaction::stop_node:
        return "its loss stops it";
      case LossReaction::stop_group:
        return "its loss stops the group " + group;
      case LossReaction::quick_stop:
        return "its loss quick stops " +
               (group.empty() ? "all drives" : "the drives of the group " + group);
    }
    return {};
  }

  void cycle() {
    const CyclePlan& c = plan_.cycle;
    const TimeBudget budget = time_budget(plan_);
    line("");
    if (!c.sync) {
      line("cycle: no SYNC; the image has a period of {}", us_text(c.period));
      line("  Outputs go out up to {} after its start; up to {} service frames a cycle.",
           us_text(c.output_deadline), c.service_frames);
      return;
    }
    line("cycle: {} (wire times with worst bit stuffing)", us_text(c.period));
    line("{:>9}  SYNC {}{}", "0 us", to_string(c.sync_cob_id),
         c.sync_overflow == 0 ? ", without counter"
                              : fmt::format(", counter 1..{}", c.sync_overflow));
    line("{:>9}  the last of {} synchronous TPDOs is in, if all devices answer at once",
         us_text(budget.earliest), cyclic_inputs());
    line("{:>9}  receive window ends: what is not in counts as missing", us_text(c.receive_window));
    line("{:>9}  outputs go out: {} RPDOs, {} on the wire", us_text(c.output_deadline),
         plan_.pdos.rpdos.size(), us_text(budget.outputs_wire));
    line("{:>9}  the master is quiet until SYNC", us_text(c.period - c.quiet_before_sync));
    if (budget.next_sync) {
      line(
          "  Time of the application: sampled at SYNC k, computed between {} and {} us ({} us), "
          "acts at SYNC k+1.",
          us(budget.earliest), us(budget.latest), us(budget.latest - budget.earliest));
    } else {
      line("  No time is left for the application: what it computes from SYNC k acts at SYNC k+2.");
    }
    line("  Process data fill {:.0f} % of the bus; up to {} service frames (SDO, NMT) a cycle.",
         100.0 * static_cast<double>((budget.inputs_wire + budget.outputs_wire).count()) /
             static_cast<double>(c.period.count()),
         c.service_frames);
    if (c.sync_window != Time{}) line("  Synchronous window (1007): {}.", us_text(c.sync_window));
  }

  std::size_t cyclic_inputs() const {
    return static_cast<std::size_t>(std::ranges::count_if(plan_.pdos.tpdos, &PdoRow::cyclic));
  }

  void node(std::size_t index) {
    const NodePlan& node = plan_.nodes[index];
    line("");
    line("node {} {}: {} ({})", node.id.value(), node.name,
         node.product_name.empty() ? "unnamed product" : node.product_name, node.description_file);
    std::string traits = node.cia402 ? "CiA 402 drive" : "";
    const auto add = [&](const std::string& text) {
      traits += (traits.empty() ? "" : ", ") + text;
    };
    if (node.mandatory) add("mandatory");
    if (!node.boot) add("only watched: no NMT, no SDO");
    add(watching(node));
    if (node.on_loss != LossReaction::report) add(reaction_text(node));
    if (node.emcy_cob_id) add("EMCY on " + to_string(*node.emcy_cob_id));
    line("  {}", traits);
    identity(node);
    device_data(node);
    for (const PdoRow& row : plan_.pdos.tpdos) {
      if (row.node_index == index) pdo(row, true);
    }
    for (const PdoRow& row : plan_.pdos.rpdos) {
      if (row.node_index == index) pdo(row, false);
    }
  }

  static std::string watching(const NodePlan& node) {
    if (node.heartbeat_timeout != Time{}) {
      return "missing after " + span_text(node.heartbeat_timeout) + " without heartbeat";
    }
    if (node.guard.period == Time{}) return "not watched (no heartbeat)";
    return "guarded every " + span_text(node.guard.period) + ", missing after " +
           span_text(node.guard.life_time());
  }

  void identity(const NodePlan& node) {
    std::string text;
    for (const BootStep& step : node.boot_plan.steps) {
      if (step.action != BootAction::expect) continue;
      text += (text.empty() ? "" : ", ") + step.purpose + " " + value_text(step);
    }
    if (!text.empty()) line("  identity: {}", text);
  }

  void device_data(const NodePlan& node) {
    if (node.device_data.empty()) return;
    line("  device data: {} ({})", node.device_data, node.device_data_file);
    for (const std::string& note : node.device_notes) line("    {}", note);
  }

  void pdo(const PdoRow& row, bool is_tpdo) {
    line("  {}{} {}  {} byte{}  {}{}", is_tpdo ? "TPDO" : "RPDO", row.number, to_string(row.cob_id),
         row.length, row.length == 1 ? "" : "s", transmission_name(row.transmission, is_tpdo),
         pdo_times(row, is_tpdo));
    unsigned expected = row.multiplexed() ? 32 : 0;  // behind address, index and sub-index
    for (std::uint16_t i = 0; i < row.field_count; ++i) {
      const PdoField& field = plan_.pdos.fields[row.first_field + i];
      const Signal& signal = plan_.layout.signals[field.signal];
      if (field.bit_offset > expected) gap(expected, field.bit_offset - expected);
      line("    bit {:>2}..{:<2}  {} {:<12} {}", field.bit_offset,
           field.bit_offset + field.bits - 1, to_string(signal.object), bits_text(signal),
           signal.name);
      expected = field.bit_offset + field.bits;
    }
    if (row.on_request || row.multiplexed()) return;
    if (expected + 7 < row.length * 8U) gap(expected, row.length * 8U - expected);
  }

  void gap(unsigned first, unsigned bits) {
    line("    bit {:>2}..{:<2}  gap", first, first + bits - 1);
  }

  static std::string pdo_times(const PdoRow& row, bool is_tpdo) {
    std::string text;
    if (row.sync_start != 0) text += fmt::format(", first at counter {}", row.sync_start);
    if (row.inhibit != Time{}) text += ", inhibit " + span_text(row.inhibit);
    if (row.event_timer != Time{}) {
      text += (is_tpdo ? ", event timer " : ", repeated after ") + span_text(row.event_timer);
    }
    if (row.deadline != Time{}) text += ", missing after " + span_text(row.deadline);
    if (row.poll != Time{}) text += ", asked for every " + span_text(row.poll);
    if (row.poll_syncs != 0) text += fmt::format(", asked for every {} SYNCs", row.poll_syncs);
    if (row.drop_late) text += ", not used when late";
    if (row.on_request) text += ", on request only";
    if (row.multiplexed()) {
      text += (row.header & 0x80) != 0 ? ", MPDO by destination" : ", MPDO by source";
    }
    return text;
  }

  void image() {
    line("");
    if (!what_.node) {
      line("image: {} inputs, {} outputs, layout {:016x}", plan_.layout.inputs,
           plan_.layout.outputs(), plan_.layout.hash);
    } else {
      line("image:");
    }
    std::size_t widest = 10;
    for (const Signal& signal : plan_.layout.signals) {
      if (wanted(signal.node)) widest = std::max(widest, full_name(signal).size());
    }
    for (std::size_t i = 0; i < plan_.layout.signals.size(); ++i) {
      const Signal& signal = plan_.layout.signals[i];
      if (wanted(signal.node)) value(i, signal, widest);
    }
  }

  std::string full_name(const Signal& signal) const {
    return plan_.nodes[signal.node_index].name + "." + signal.name;
  }

  void value(std::size_t i, const Signal& signal, std::size_t widest) {
    const std::string unit =
        signal.unit.empty() && signal.scale == 1.0 && signal.offset == 0.0
            ? ""
            : fmt::format("  x {}{} {}", number(signal.scale),
                          signal.offset == 0.0 ? "" : " + " + number(signal.offset), signal.unit);
    line("  {:>4} {} {:<{}}  {} {:<10}{}{}", i, signal.output ? "out" : "in ", full_name(signal),
         widest, to_string(signal.object), bits_text(signal), unit,
         signal.output ? output_text(signal) : "");
  }

  std::string output_text(const Signal& signal) const {
    std::string text = "  first ";
    if (signal.safe_value) {
      text += std::to_string(*signal.safe_value);
    } else if (signal.seeded_from) {
      text += plan_.layout.signals[*signal.seeded_from].name;
    } else {
      text += "when commanded";
    }
    text += "; ";
    if (signal.fallback_cycles == 0) return text + "a command lasts";
    text += fmt::format("after {} cycle{} ", signal.fallback_cycles,
                        signal.fallback_cycles == 1 ? "" : "s");
    return text + (signal.fallback == Fallback::hold ? "held" : fallback_text(signal));
  }

  static std::string fallback_text(const Signal& signal) {
    const auto raw = static_cast<std::uint64_t>(signal.fallback_value);
    const bool controlword = signal.object.index % 0x800 == 0x40 && signal.bits == 16;
    return controlword ? fmt::format("0x{:04X}", raw) : std::to_string(signal.fallback_value);
  }

  void lcm() {
    line("");
    line("LCM: {}{}",
         what_.lcm.url.empty() ? "default URL (LCM_DEFAULT_URL, --lcm-url)" : what_.lcm.url,
         what_.lcm.broker ? ", own broker" : "");
    std::size_t widest = 0;
    const std::vector<LcmChannel> channels = lcm_channels(plan_);
    for (const LcmChannel& channel : channels) widest = std::max(widest, channel.name.size());
    for (const LcmChannel& channel : channels) {
      line("  {:<{}}  {:<15} {}", channel.name, widest, channel.type, channel.content);
    }
  }

  void boot(const NodePlan& node) {
    line("");
    if (node.boot_plan.steps.empty()) {
      line("boot of node {} {}: none, it is only watched", node.id.value(), node.name);
      return;
    }
    line("boot of node {} {}: {} steps; SDO answers within {}, tried again after {}{}",
         node.id.value(), node.name, node.boot_plan.steps.size(), span_text(node.sdo_timeout),
         span_text(node.reboot_delay),
         node.start_later ? "; started with the network, by one broadcast" : "");
    const std::vector<bool> inside = skippable(node.boot_plan);
    for (std::size_t i = 0; i < node.boot_plan.steps.size(); ++i) {
      step(node, i, inside[i]);
    }
  }

  void step(const NodePlan& node, std::size_t i, bool inside) {
    const BootStep& step = node.boot_plan.steps[i];
    const std::string action = (inside ? "  " : "") + std::string{action_name(step.action)};
    const char letter = step.action == BootAction::skip_if_same ? ' ' : step.letter;
    line("  {:>4} {} {:<18} {:<21} {:<10} {:>9}  {}", i + 1, letter, action,
         frame_text(step, node.id), step_value(step), step_limit(step), step.purpose);
  }

  /// How long the step may take: of the wait, of each silence of an SDO transfer.
  static std::string step_limit(const BootStep& step) {
    if (step.action == BootAction::nmt || step.action == BootAction::skip_if_same) return {};
    return "<" + span_text(step.timeout);
  }

  static std::string step_value(const BootStep& step) {
    switch (step.action) {
      case BootAction::nmt:
      case BootAction::probe:
      case BootAction::read_serial:
      case BootAction::disable_pdo:
        return {};
      case BootAction::skip_if_same:
        return fmt::format("-> {}", step.target + 1);
      case BootAction::await_bootup:
      case BootAction::await_heartbeat:
      case BootAction::await_guarding:
      case BootAction::await_operational:
      case BootAction::pause:
        return {};
      case BootAction::await_alive:
        return fmt::format("-> {}", step.target + 1);
      default:
        return value_text(step);
    }
  }

  std::ostream& out_;
  const BusPlan& plan_;
  const PlanPrint& what_;
};

}  // namespace

void print_plan_text(std::ostream& out, const BusPlan& plan, const PlanPrint& what) {
  PlanText{out, plan, what}.run();
}

}  // namespace takt
