#include "master/explain/stop_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "master/core/network/axis_stop.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

constexpr unsigned axis_step = 0x800;
constexpr std::uint32_t by_position = 1U << 16U;

unsigned axis_number(const Event& event) { return event.detail >> 8U & 0xFF; }

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

/// The units of this axis, or nullptr if the plan has no such axis.
const AxisPlan* axis_of(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  if (node == nullptr) return nullptr;
  const auto axis = std::ranges::find(node->axes, axis_number(event), &AxisPlan::number);
  return axis == node->axes.end() ? nullptr : &*axis;
}

/// The speed in the unit of the network file, and in mm/s below 1 m/s. The value is raw if the file
/// gives no unit.
std::string velocity_text(const BusPlan& plan, const Event& event) {
  const bool differences = (event.detail & by_position) != 0;
  const AxisPlan* const axis = axis_of(plan, event);
  const auto raw = static_cast<double>(event.value);
  const RawUnit own = axis == nullptr ? RawUnit{}
                      : differences   ? axis->position_unit
                                      : axis->velocity_unit;
  if (own.unit.empty()) return number_text(raw) + (differences ? " counts/s" : " (606C)");
  const double speed = std::abs(raw * own.scale);
  const std::string unit = own.unit + (differences ? "/s" : "");
  if (unit == "m/s" && speed < 1) return number_text(speed * 1000) + " mm/s";
  return number_text(speed) + " " + unit;
}

std::string refusal_text(const Event& event) {
  const auto code = static_cast<std::uint32_t>(event.value);
  const auto index = static_cast<std::uint16_t>(0x6041 + axis_number(event) * axis_step);
  const std::string object =
      "statusword " + to_string(ObjectKey{index, 0}) + " (" + abort_digits(code) + ")";
  const bool missing = code == abort_code::no_object;
  return (missing ? "reports that it has no " : "refuses to send its ") + object +
         ": takt does not know whether the drive is enabled";
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
  return "the loss is reported";
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
      return "was disabled before a value could show that it stood still";
  }
  return "was not stopped";
}

std::string named_axis_stop_text(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  std::string text = node == nullptr ? "node " + std::to_string(int{event.node}) : node->name;
  if (const unsigned axis = axis_number(event); axis != 0) {
    text += " axis " + std::to_string(axis + 1);
  }
  const auto verdict = static_cast<AxisVerdict>(event.detail & 0xFF);
  const bool sentence = verdict != AxisVerdict::silent && verdict != AxisVerdict::lost;
  return text + (sentence ? " " : ": ") + axis_stop_text(plan, event);
}

std::string coasting_text(const Event& event) {
  const std::string object = to_string(quick_stop_option(static_cast<unsigned>(event.value)));
  return "a quick stop disables the drive at once, and the axis coasts, because " + object +
         " is 0 in the device: an ordered stop confirms the axis only if it stood still before; "
         "write `sdo: [{index: 0x" +
         object.substr(0, 4) + ", value: 2}]` for a ramp";
}

std::string still_armed_text(const Event& event) {
  const ObjectKey object{static_cast<std::uint16_t>(event.detail >> 8U),
                         static_cast<std::uint8_t>(event.detail)};
  std::string why = "did not confirm the write";
  if (event.value < 0) why = "gave no answer within " + time_text(Time{-event.value});
  if (event.value > 0) {
    why = "refused the write (" + abort_digits(static_cast<std::uint32_t>(event.value)) + ")";
  }
  return "the write that disarms " + to_string(object) + " failed, because the device " + why +
         ": it may report the loss of its master";
}

}  // namespace takt
