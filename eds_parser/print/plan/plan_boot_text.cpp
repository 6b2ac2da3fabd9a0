#include <string>
#include <vector>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/print/plan/step_frames.hpp"

namespace takt {
namespace {

/// Marks the steps inside a `compare ... skip if same ... target` group, which are indented.
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

class BootText {
 public:
  BootText(PlanLines& lines, const NodePlan& node) : lines_{lines}, node_{node} {}

  void boot() {
    lines_.line("");
    if (node_.boot_plan.steps.empty()) {
      lines_.line("boot of node {} {}: no boot, because the node is only watched", node_.id.value(),
                  node_.name);
      return;
    }
    lines_.line(
        "boot of node {} {}: {} steps; SDO answers within {}; a failed boot starts again after "
        "{}{}",
        node_.id.value(), node_.name, node_.boot_plan.steps.size(), span_text(node_.sdo_timeout),
        pauses(), node_.start_later ? "; started with the network, by one broadcast" : "");
    lines_.line(
        "  NMT enter PRE-OPERATIONAL before the first write, unless the heartbeat shows this "
        "state");
    sdo_access();
    const std::vector<bool> inside = skippable(node_.boot_plan);
    const std::vector<StepFrames> frames = step_frames(node_);
    for (std::size_t i = 0; i < node_.boot_plan.steps.size(); ++i) {
      step(i, inside[i], frames[i].first);
    }
  }

 private:
  std::string pauses() const {
    const std::string first = span_text(node_.reboot_delay);
    if (node_.longest_reboot_delay <= node_.reboot_delay) return first;
    return first + ", then twice as long each time up to " + span_text(node_.longest_reboot_delay);
  }

  /// Prints only values that differ from the defaults.
  void sdo_access() {
    if (const auto& channel = node_.sdo.channel) {
      lines_.line("  SDO channel: requests on {}, answers on {}", to_string(channel->request),
                  to_string(channel->answer));
    }
    if (node_.sdo.block == SdoBlockUse::off) lines_.line("  SDO block transfer is never used");
  }

  void step(std::size_t i, bool inside, const std::string& frame) {
    const BootStep& step = node_.boot_plan.steps[i];
    const std::string action = (inside ? "  " : "") + std::string{action_name(step.action)};
    const char letter = step.action == BootAction::skip_if_same ? ' ' : step.letter;
    lines_.line("  {:>4} {} {:<18} {:<21} {:<10} {:>9}  {}", i + 1, letter, action, frame,
                step_value(step), step_limit(step), step.purpose);
  }

  /// Returns the limit of the step: of its wait, or of each silence in its SDO transfer.
  static std::string step_limit(const BootStep& step) {
    if (step.action == BootAction::nmt || step.action == BootAction::skip_if_same) return {};
    return "<" + span_text(step.timeout);
  }

  static std::string step_value(const BootStep& step) {
    switch (step.action) {
      case BootAction::nmt:
      case BootAction::probe:
      case BootAction::read_serial:
      case BootAction::read_firmware:
      case BootAction::read_limit:
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

  PlanLines& lines_;
  const NodePlan& node_;
};

}  // namespace

void add_boot(PlanLines& lines, const NodePlan& node) { BootText{lines, node}.boot(); }

}  // namespace takt
