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

std::string pauses(const NodePlan& node) {
  const std::string first = span_text(node.reboot_delay);
  if (node.longest_reboot_delay <= node.reboot_delay) return first;
  return first + ", then twice as long each time up to " + span_text(node.longest_reboot_delay);
}

/// Prints only values that differ from the defaults.
void add_sdo_access(PlanLines& lines, const SdoAccess& sdo) {
  if (sdo.channel) {
    lines.line("  SDO channel: requests on {}, answers on {}", to_string(sdo.channel->request),
               to_string(sdo.channel->answer));
  }
  if (sdo.block == SdoBlockUse::off) lines.line("  SDO block transfer is never used");
}

/// Returns the number of the step to which a jump leads, or the value of the object.
std::string step_value(const BootStep& step) {
  const bool jumps =
      step.action == BootAction::skip_if_same || step.action == BootAction::await_alive;
  return jumps ? fmt::format("-> {}", step.target + 1) : value_text(step);
}

/// Returns the limit of the step: of its wait, or of each silence in its SDO transfer.
std::string step_limit(const BootStep& step) {
  if (step.action == BootAction::nmt || step.action == BootAction::skip_if_same) return {};
  return "<" + span_text(step.timeout);
}

}  // namespace

void add_boot(PlanLines& lines, const NodePlan& node) {
  const std::vector<BootStep>& steps = node.boot_plan.steps;
  lines.line("");
  if (steps.empty()) {
    lines.line("boot of node {} {}: no boot, because the node is only watched", node.id.value(),
               node.name);
    return;
  }
  lines.line(
      "boot of node {} {}: {} steps; SDO answers within {}; a failed boot starts again "
      "after {}{}",
      node.id.value(), node.name, steps.size(), span_text(node.sdo_timeout), pauses(node),
      node.start_later ? "; started with the network, by one broadcast" : "");
  lines.line(
      "  NMT enter PRE-OPERATIONAL before the first write, unless the heartbeat shows this state");
  add_sdo_access(lines, node.sdo);
  const std::vector<bool> inside = skippable(node.boot_plan);
  const std::vector<StepFrames> frames = step_frames(node);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const BootStep& step = steps[i];
    const std::string action = (inside[i] ? "  " : "") + std::string{action_name(step.action)};
    const char letter = step.action == BootAction::skip_if_same ? ' ' : step.letter;
    lines.line("  {:>4} {} {:<18} {:<21} {:<10} {:>9}  {}", i + 1, letter, action, frames[i].first,
               step_value(step), step_limit(step), step.purpose);
  }
}

}  // namespace takt
