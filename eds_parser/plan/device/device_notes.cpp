#include "eds_parser/plan/device/device_rules.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

std::string numbers_text(const PdoRule& rule) {
  const auto& [low, high] = rule.numbers;
  const std::string_view kind = rule.is_tpdo ? "TPDO" : "RPDO";
  if (low == high) return concat(kind, low);
  return high >= 512 ? concat(kind, "s") : concat(kind, low, "..", high);
}

std::string rule_text(const PdoRule& rule) {
  std::string text;
  const auto add = [&](bool says, const std::string& what) {
    if (says) text += (text.empty() ? ": " : ", ") + what;
  };
  add(!rule.types.empty(), "types " + list_of(rule.types));
  add(rule.without_timer, "no event timer");
  add(rule.without_rtr, "no remote requests");
  add(rule.no_more_entries, "no more objects than its default mapping has");
  add(rule.no_gaps, "only together with the PDO before");
  add(rule.function == PdoFunction::parameter_channel, "the parameter channel");
  return numbers_text(rule) + text;
}

}  // namespace

std::string list_of(const std::vector<NumberRange>& ranges) {
  std::string text;
  for (const NumberRange& range : ranges) {
    append_item(text, range.low);
    if (range.high != range.low) text += concat("..", range.high);
  }
  return text;
}

std::vector<std::string> device_notes(const NodePdos& node) {
  std::vector<std::string> notes;
  if (node.node.data == nullptr) return notes;
  const DeviceData& data = *node.node.data;
  const auto add = [&](const auto&... parts) { notes.push_back(concat(parts...)); };
  if (data.node_ids.fact.pos != SourcePos{}) add("node ids ", list_of({data.node_ids.ids}));
  if (data.heartbeat.multiple_of_ms != 1) {
    add("heartbeat times in steps of ", data.heartbeat.multiple_of_ms, " ms, rounded down");
  }
  for (const ValueEdit& edit : data.values) add("needs ", edit.object, " = ", edit.value);
  for (const TimeoutEdit& edit : data.timeouts) {
    const SdoObjectTimeout& slow = edit.timeout;
    add(slow.sub ? to_string(ObjectKey{slow.index, *slow.sub}) : hex(slow.index), ": SDO time-out ",
        microseconds_text(static_cast<std::uint64_t>(slow.timeout / 1us)));
  }
  for (const PdoRule& rule : data.pdos) add(rule_text(rule));
  const InhibitRule& inhibit = data.inhibit;
  const std::string by_default = microseconds_text(inhibit.us(inhibit.factory)) + " by default";
  if (inhibit.unit_us != 100 || inhibit.least != 0) {
    add("inhibit times in steps of ", microseconds_text(inhibit.unit_us), ", at least ",
        microseconds_text(inhibit.us(inhibit.least)),
        inhibit.factory == 0 ? "" : ", " + by_default);
  } else if (inhibit.factory != 0) {
    add("inhibit times of ", by_default);
  }
  if (data.timer.meaning == TimerMeaning::additional) {
    add("event timers send in addition to changes; a change does not restart the timer");
  }
  if (data.timer.meaning == TimerMeaning::alone) {
    add("with an event timer, a change sends no PDO");
  }
  for (const SdoServerFact& server : data.sdo_servers) {
    add("SDO channel ", server.index - 0x1200 + 1, " on ",
        hex(server.request + node.node.id.value(), 3), " and ",
        hex(server.answer + node.node.id.value(), 3));
  }
  if (const SpeedAxisSpec& axis = data.speed_axis; axis.is_stated()) {
    add("speed axis: control word ", *axis.control, ", set speed ", axis.set_speed->object, " in ",
        axis.set_speed->unit, ", status word ", *axis.status,
        axis.ramps.empty() ? "" : "; ramps: " + axis.ramps);
    if (!axis.source.empty()) add("these words: ", axis.source);
  }
  if (node.node.firmware) add("firmware ", *node.node.firmware);
  return notes;
}

}  // namespace takt
