#include "apps/axis/not_ready.hpp"

#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <utility>

#include "master/explain/emcy_text.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr std::uint16_t voltage_enabled = 0x0010;
constexpr std::uint16_t remote = 0x0200;
/// Values of node_status_t::boot_state.
constexpr std::int16_t boot_ready = 2;
constexpr std::int16_t boot_failed = 3;
constexpr std::int16_t boot_lost = 4;

}  // namespace

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

std::string blocking_bits(std::uint16_t statusword) {
  using enum State402;
  const auto bit = [&](int number, std::string_view meaning, int value) {
    return fmt::format("bit {} ({}) of its statusword 0x{:04X} is {}", number, meaning, statusword,
                       value);
  };
  const std::optional<State402> state = decode_statusword(statusword);
  if (state == operation_enabled) return {};
  std::string text;
  if (!state) {
    text = fmt::format("its statusword 0x{:04X} shows no state of CiA 402", statusword);
  } else if (state == fault || state == fault_reaction_active) {
    text = bit(3, "fault", 1);
  } else if (state == switch_on_disabled) {
    text = bit(6, "switch on disabled", 1);
  } else if (state == quick_stop_active) {
    text = bit(5, "quick stop", 0);
  } else if (state == switched_on) {
    text = bit(2, "operation enabled", 0);
  } else if (state == ready_to_switch_on) {
    text = bit(1, "switched on", 0);
  } else {
    text = bit(0, "ready to switch on", 0);
  }
  if ((statusword & voltage_enabled) == 0) {
    text += "; bit 4 (voltage enabled) is 0: is its power supply on?";
  }
  if ((statusword & remote) == 0) {
    text += "; bit 9 (remote) is 0: the drive ignores the controlword; is it in local control?";
  }
  return text;
}

std::string newest_error(const node_status_t& node) {
  if (node.num_emcys < 1 || node.emcys.empty()) return {};
  const auto code = static_cast<std::uint16_t>(node.emcys.front());
  if (code == 0) return {};
  return fmt::format("its newest error is 0x{:04X} ({})", code, emcy_text(code));
}

std::vector<std::string> why_not_ready(const AxisGroup& group, AxisControl::Index axis,
                                       DriveMode mode) {
  const AxisControl& axes = group.axes();
  std::vector<std::string> lines;
  const std::string& axis_name = axes.name(axis);
  const std::optional<node_status_t> node = group.node_status(axis);
  const NodeHolder& holder = group.holder(axis);
  const bool answers = !axes.stale(axis);
  if (node && node->boot_state != boot_ready) {
    lines.push_back(fmt::format("{}: its device has not booted ({})", axis_name,
                                node->boot_state == boot_failed ? "its boot has failed"
                                : node->boot_state == boot_lost ? "it is lost"
                                                                : "its boot has not ended"));
  } else if (!answers) {
    lines.push_back(axis_name + ": its statusword or its position has not arrived");
  } else if (!axes.drive(axis).enabled()) {
    const std::string error = node && axes.drive(axis).in_fault() ? newest_error(*node) : "";
    lines.push_back(
        fmt::format("{}: not enabled, {}: {}{}{}", axis_name, name(axes.drive(axis).state()),
                    blocking_bits(axes.statusword(axis)), error.empty() ? "" : "; ", error));
  }
  if (holder.is_other()) {
    lines.push_back(fmt::format("{} belongs to '{}', and the commands of this program are refused",
                                axis_name, printable_text(holder.name)));
  } else if (!holder.own && lines.empty()) {
    lines.push_back("the daemon does not show that this program holds " + axis_name);
  }
  const std::string hint = mode_hint(axes.signals(axis), group.input(), mode);
  if (answers && !hint.empty()) lines.push_back(axis_name + ": " + hint);
  return lines;
}

}  // namespace takt
