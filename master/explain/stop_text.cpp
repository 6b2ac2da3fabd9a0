#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "master/core/network/axis_stop.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/event_text.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

constexpr unsigned axis_step = 0x800;
constexpr std::uint32_t by_position = 1U << 16U;

unsigned axis_number(const Event& event) { return event.detail >> 8U & 0xFF; }

/// Returns the plan of the axis of an event, or nullptr if there is no such axis.
const AxisPlan* axis_of(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  if (node == nullptr) return nullptr;
  const auto axis = std::ranges::find(node->axes, axis_number(event), &AxisPlan::number);
  return axis == node->axes.end() ? nullptr : &*axis;
}

/// Returns the speed in the unit of the network file, or in mm/s if it is below 1 m/s. Returns the
/// raw value if the file states no unit.
std::string velocity_text(const BusPlan& plan, const Event& event) {
  const bool differences = (event.detail & by_position) != 0;
  const AxisPlan* const axis = axis_of(plan, event);
  const auto raw = static_cast<double>(event.value);
  const RawUnit own = axis == nullptr ? RawUnit{}
                      : differences   ? axis->position_unit
                                      : axis->velocity_unit;
  if (own.unit.empty()) return fmt::format("{:.3g}{}", raw, differences ? " counts/s" : " (606C)");
  const double speed = std::abs(raw * own.scale);
  const std::string unit = own.unit + (differences ? "/s" : "");
  if (unit == "m/s" && speed < 1) return fmt::format("{:.3g} mm/s", speed * 1000);
  return fmt::format("{:.3g} {}", speed, unit);
}

std::string refusal_text(const Event& event) {
  const auto code = static_cast<std::uint32_t>(event.value);
  const auto index = static_cast<std::uint16_t>(0x6041 + axis_number(event) * axis_step);
  return fmt::format(
      "{} statusword {} ({}): takt does not know whether the drive is enabled",
      code == abort_code::no_object ? "reports that it has no" : "refuses to send its",
      to_string(ObjectKey{index, 0}), abort_digits(code));
}

}  // namespace

std::string reaction_text(const Event& event) {
  switch (static_cast<LossReaction>(event.value)) {
    case LossReaction::stop_node:
      return "NMT stop to the node; it stays in STOPPED until it is reset or started (`takt nmt "
             "reset`)";
    case LossReaction::stop_group:
      return "NMT stop to its group; the nodes stay in STOPPED until they are reset or started";
    case LossReaction::quick_stop:
      return "quick stop of the drives that depend on the node";
    case LossReaction::report:
      break;
  }
  return "the master only reports the loss";
}

std::string axis_stop_text(const BusPlan& plan, const Event& event) {
  switch (static_cast<AxisVerdict>(event.detail & 0xFF)) {
    case AxisVerdict::stopped:
      return "was stopped and disabled";
    case AxisVerdict::moving:
      return "was disabled at " + velocity_text(plan, event);
    case AxisVerdict::enabled:
      return "was not disabled, its velocity is " + velocity_text(plan, event);
    case AxisVerdict::silent:
      return "no answer for " + time_text(Time{event.value});
    case AxisVerdict::lost:
      return "the drive is lost, no answer for " + time_text(Time{event.value});
    case AxisVerdict::refused:
      return refusal_text(event);
    case AxisVerdict::unproven:
      return "was disabled before any value showed that it was at standstill";
  }
  return "was not stopped";
}

std::string named_axis_stop_text(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  const unsigned axis = axis_number(event);
  const auto verdict = static_cast<AxisVerdict>(event.detail & 0xFF);
  const bool sentence = verdict != AxisVerdict::silent && verdict != AxisVerdict::lost;
  return fmt::format("{}{}{} {}", node == nullptr ? fmt::format("node {}", event.node) : node->name,
                     axis == 0 ? "" : fmt::format(" axis {}", axis + 1), sentence ? "" : ":",
                     axis_stop_text(plan, event));
}

std::string coasting_text(const Event& event) {
  const std::string object = to_string(quick_stop_option(static_cast<unsigned>(event.value)));
  return fmt::format(
      "a quick stop disables the drive at once, and the axis coasts, because {} is 0 in the "
      "device: an ordered stop confirms the axis only if it stood still before; write `sdo: "
      "[{{index: 0x{}, value: 2}}]` for a ramp",
      object, object.substr(0, 4));
}

std::string still_armed_text(const Event& event) {
  const ObjectKey object{static_cast<std::uint16_t>(event.detail >> 8U),
                         static_cast<std::uint8_t>(event.detail)};
  std::string why = "did not confirm the write";
  if (event.value < 0) why = "gave no answer within " + time_text(Time{-event.value});
  if (event.value > 0) {
    why = fmt::format("refused the write ({})",
                      abort_digits(static_cast<std::uint32_t>(event.value)));
  }
  return fmt::format(
      "the write to {} that ends the supervision of the master failed, because the device {}: the "
      "device may report the loss of its master",
      to_string(object), why);
}

}  // namespace takt
