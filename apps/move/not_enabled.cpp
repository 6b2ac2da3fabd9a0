#include "apps/move/not_enabled.hpp"

#include <fmt/format.h>

#include "apps/move/mode_hint.hpp"

namespace takt {

std::vector<std::string> why_not_ready(AxisGroup& group) {
  const AxisControl& axes = group.axes();
  std::vector<std::string> lines;
  for (AxisControl::Index i = 0; i < axes.size(); ++i) {
    if (!axes.drive(i).enabled()) {
      lines.push_back(
          fmt::format("{}: not enabled, {}", axes.name(i), name(axes.drive(i).state())));
    } else if (!group.holder(i).own) {
      lines.push_back("the daemon does not show that this program holds " + axes.name(i));
    }
  }
  for (AxisControl::Index i = 0; i < axes.size(); ++i) {
    const std::string hint = mode_hint(axes.signals(i), group.input(), DriveMode::cyclic_position);
    if (!hint.empty()) lines.push_back(axes.name(i) + ": " + hint);
  }
  return lines;
}

}  // namespace takt
