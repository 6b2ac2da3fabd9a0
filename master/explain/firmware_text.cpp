#include "master/explain/firmware_text.hpp"

namespace takt {

std::string firmware_text(const FirmwarePlan& plan, const Firmware& is) {
  std::string text = "the firmware is " + to_string(is) + " (" + to_string(plan.object) +
                     "), but the plan assumes " + to_string(plan.assumed) + ": ";
  std::string consequences;
  for (const FirmwareRule& rule : plan.rules) {
    if (rule.holds(is) == rule.holds(plan.assumed)) continue;
    consequences += (consequences.empty() ? "" : "; ") +
                    std::string{rule.holds(is) ? "" : "this does not hold: "} + rule.text;
  }
  text +=
      consequences.empty() ? "nothing in the device data depends on this difference" : consequences;
  return text + ". Write `firmware: \"" + to_string(is) +
         "\"` for this node, and check the plan with `takt plan`";
}

}  // namespace takt
