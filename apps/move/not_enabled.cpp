#include "apps/move/not_enabled.hpp"

#include <fmt/format.h>
#include <utility>

namespace takt {

std::string mode_hint(const AxisSignals& signals, const ImageInput& input, DriveMode mode) {
  const std::string wanted = std::to_string(std::to_underlying(mode));
  const std::string remedy =
      "map 0x6060 into an RPDO, or write " + wanted + " to 0x6060 under `sdo:` of the network file";
  if (!signals.mode_display) {
    if (signals.mode) return {};
    return "the mode of operation is unknown: map 0x6060 into an RPDO, or 0x6061 into a TPDO if "
           "`sdo:` writes 0x6060";
  }
  if (input.stale(*signals.mode_display)) {
    const std::string unknown = "the mode of operation is unknown: 0x6061 has not arrived";
    return signals.mode ? unknown : unknown + ", and no RPDO contains 0x6060: " + remedy;
  }
  const auto shown = static_cast<std::int8_t>(input.values()[*signals.mode_display]);
  if (shown == std::to_underlying(mode)) return {};
  const std::string now = "0x6061 shows mode " + std::to_string(shown) + " instead of " + wanted;
  if (signals.mode) {
    return now + ", which 0x6060 commands: does the drive support this mode (0x6502), and accept " +
           "it in its present state?";
  }
  if (shown != 0) return now + ", and no RPDO contains 0x6060: " + remedy;
  return "no mode of operation is set (0x6061 shows 0), and no RPDO contains 0x6060: " + remedy;
}

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
