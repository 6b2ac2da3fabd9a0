#include "eds_parser/plan/device/device_notes.hpp"

#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

std::string numbers_text(const PdoRule& rule) {
  const std::string kind = rule.is_tpdo ? "TPDO" : "RPDO";
  if (rule.numbers.low == rule.numbers.high) return kind + std::to_string(rule.numbers.low);
  if (rule.numbers.high >= 512) return kind + "s";
  return kind + std::to_string(rule.numbers.low) + ".." + std::to_string(rule.numbers.high);
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
    text += (text.empty() ? "" : ", ") + std::to_string(range.low);
    if (range.high != range.low) text += ".." + std::to_string(range.high);
  }
  return text;
}

std::string time_text(std::uint64_t us) {
  if (us % 1000 == 0) return std::to_string(us / 1000) + " ms";
  return std::to_string(us) + " us";
}

std::vector<std::string> device_notes(const NodePdos& node) {
  std::vector<std::string> notes;
  if (node.node.data == nullptr) return notes;
  const DeviceData& data = *node.node.data;
  if (data.node_ids.fact.pos != SourcePos{}) {
    notes.push_back("node ids " + list_of({data.node_ids.ids}));
  }
  if (data.heartbeat.multiple_of_ms != 1) {
    notes.push_back("heartbeat times in steps of " + std::to_string(data.heartbeat.multiple_of_ms) +
                    " ms, rounded down");
  }
  for (const ValueEdit& edit : data.values) {
    notes.push_back("needs " + to_string(edit.object) + " = " + std::to_string(edit.value));
  }
  for (const TimeoutEdit& edit : data.timeouts) {
    const SdoObjectTimeout& slow = edit.timeout;
    notes.push_back((slow.sub ? to_string(ObjectKey{slow.index, *slow.sub}) : hex(slow.index)) +
                    ": SDO time-out " + time_text(static_cast<std::uint64_t>(slow.timeout / 1us)));
  }
  for (const PdoRule& rule : data.pdos) notes.push_back(rule_text(rule));
  if (data.inhibit.unit_us != 100 || data.inhibit.least != 0) {
    notes.push_back(
        "inhibit times in steps of " + time_text(data.inhibit.unit_us) + ", at least " +
        time_text(std::uint64_t{data.inhibit.least} * data.inhibit.unit_us) +
        (data.inhibit.factory == 0
             ? ""
             : ", " + time_text(std::uint64_t{data.inhibit.factory} * data.inhibit.unit_us) +
                   " by default"));
  }
  if (data.inhibit.unit_us == 100 && data.inhibit.least == 0 && data.inhibit.factory != 0) {
    notes.push_back("inhibit times of " + time_text(std::uint64_t{data.inhibit.factory} * 100) +
                    " by default");
  }
  if (data.timer.meaning == TimerMeaning::additional) {
    notes.emplace_back(
        "event timers send in addition to changes; a change does not restart the timer");
  }
  if (data.timer.meaning == TimerMeaning::alone) {
    notes.emplace_back("with an event timer, a change sends no PDO");
  }
  for (const SdoServerFact& server : data.sdo_servers) {
    notes.push_back("SDO channel " + std::to_string(server.index - 0x1200 + 1) + " on " +
                    hex(server.request + node.node.id.value(), 3) + " and " +
                    hex(server.answer + node.node.id.value(), 3));
  }
  if (node.node.firmware) notes.push_back("firmware " + to_string(*node.node.firmware));
  return notes;
}

}  // namespace takt
