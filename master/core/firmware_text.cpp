#include "master/core/firmware_text.hpp"

namespace takt {

std::string firmware_text(const FirmwarePlan& plan, const Firmware& is) {
  std::string text = "its firmware is " + to_string(is) + " (" + to_string(plan.object) +
                     "), the plan takes it for " + to_string(plan.assumed) + ": ";
  std::string consequences;
  for (const FirmwareRule& rule : plan.rules) {
    if (rule.holds(is) == rule.holds(plan.assumed)) continue;
    consequences += (consequences.empty() ? "" : "; ") +
                    std::string{rule.holds(is) ? "" : "it is not so that "} + rule.text;
  }
  text += consequences.empty() ? "nothing in the device data depends on that" : consequences;
  return text + ". Write `firmware: \"" + to_string(is) + "\"` for it, and read `takt plan`";
}

}  // namespace takt
