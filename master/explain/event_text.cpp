#include <algorithm>
#include <string>

#include "eds_parser/table/tpdo_of.hpp"
#include "master/core/command_limit.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/bus_event_text.hpp"
#include "master/explain/emcy_text.hpp"
#include "master/explain/firmware_text.hpp"
#include "master/explain/limit_text.hpp"
#include "master/explain/report_text.hpp"
#include "master/explain/stop_text.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::string signal_name(const BusPlan& plan, std::int64_t index) {
  const auto& signals = plan.layout.signals;
  if (index < 0 || static_cast<std::size_t>(index) >= signals.size()) {
    return "signal " + std::to_string(index);
  }
  const Signal& signal = signals[static_cast<std::size_t>(index)];
  return signal.name + " (" + to_string(signal.object) + ")";
}

/// Describes which TPDO carries an actual position, and what makes the device send it soon.
std::string first_time_text(const BusPlan& plan, SignalIndex signal) {
  const PdoRow* const pdo = tpdo_of(plan.pdos, signal);
  if (pdo == nullptr) return {};
  const std::string tpdo = "TPDO" + std::to_string(pdo->number);
  if (!comes_by_event_alone(*pdo)) return "; check whether the device sends " + tpdo;
  return "; the device sends " + tpdo +
         " only by event: give the TPDO an `event_timer`, or make it synchronous (`transmission: "
         "1`)";
}

std::string held_line(const BusPlan& plan, const Event& event) {
  const std::string rpdo = "RPDO" + std::to_string(event.value) + " is held back until ";
  if (event.detail == 0) return rpdo + "each of its signals has a commanded, safe or seeded value";
  const auto awaited = static_cast<SignalIndex>(event.detail - 1);
  return rpdo + signal_name(plan, awaited) +
         " has come from the device for the first time: takt checks the first position command "
         "with `limits:` against this value" +
         first_time_text(plan, awaited);
}

std::string_view emcy_meaning(const BusPlan& plan, std::uint8_t node, std::uint16_t code) {
  const NodePlan* const planned = plan.find(node);
  if (planned == nullptr) return emcy_text(code);
  const auto own = std::ranges::find(planned->emcy_texts, code, &EmcyText::code);
  return own == planned->emcy_texts.end() ? emcy_text(code) : std::string_view{own->text};
}

std::string emcy_line(const BusPlan& plan, const Event& event) {
  const std::size_t length = event.detail == 0 ? 8 : std::min<std::size_t>(event.detail, 8);
  const std::span bytes{event.bytes};
  std::string text = "EMCY of 1 byte, too short for an error code (bytes";
  if (length > 1) {
    const auto code = load_le<std::uint16_t>(bytes);
    text = "EMCY " + hex(code) + ": " + std::string{emcy_meaning(plan, event.node, code)} + " (";
    if (length > 2) text += "error register: " + error_register_text(bytes[2]) + "; ";
    text += "bytes";
  }
  for (const std::uint8_t byte : bytes.first(length)) text += " " + hex(byte, 2).substr(2);
  text += length == 8 ? ")" : ", always 8)";
  if (event.value > 0)
    text += "; " + std::to_string(event.value) + " earlier ones were not reported";
  return text;
}

std::string boot_done_text(const Event& event) {
  std::string text = "ready after " + std::to_string(event.detail) + " ms";
  if (event.value != 1) return text;
  text += "; the node was operational already and was not reset (status L of CiA 302-2)";
  const auto left_alone = load_le<std::uint16_t>(std::span{event.bytes});
  if (left_alone == 0) return text;
  const ObjectKey first{load_le<std::uint16_t>(std::span{event.bytes}.subspan(2)), event.bytes[4]};
  return text + "; " + std::to_string(left_alone) +
         (left_alone == 1 ? " object differs" : " objects differ") +
         " from the network file until the node is reset, the first is " + to_string(first);
}

std::string twin_text(const Event& event) {
  if (event.value == static_cast<std::int64_t>(DuplicateSign::answers)) {
    return "several answers came to each SDO request: two devices have this node id, or another "
           "SDO client uses the server; switch one device off, or give it another id (`takt lss`)";
  }
  return "twice as many heartbeats came as one device sends: two devices have this node id; switch "
         "one device off, or give it another id (`takt lss`)";
}

std::string lss_trouble_text(const BusPlan& plan, const Event& event) {
  const LssResult result{.op = static_cast<LssOp>(event.bytes[0]),
                         .outcome = static_cast<LssOutcome>(event.bytes[1]),
                         .error = event.bytes[2],
                         .specific = event.bytes[3]};
  const NodePlan* const node = plan.find(event.node);
  if (result.outcome == LssOutcome::nobody && node != nullptr && node->lss) {
    return "a device without node id answers LSS, but no such device has " +
           identity_text(*node->lss) +
           ", which the network file gives this node: `takt lss find` shows the devices without "
           "node id";
  }
  return "a device without node id is on the bus, but LSS failed: " + lss_failure_text(result);
}

std::string no_block_text(const Event& event) {
  const auto object = to_string(ObjectKey{static_cast<std::uint16_t>(event.detail >> 8U),
                                          static_cast<std::uint8_t>(event.detail)});
  const std::string what = event.value == 0
                               ? "gives no answer to SDO block transfer (" + object + ")"
                               : "refuses SDO block transfer (" + object + ", " +
                                     abort_digits(static_cast<std::uint32_t>(event.value)) + ")";
  return what +
         ": the master uses segmented transfer for this and all other values until the node is "
         "reset; `sdo_block: never` of this node avoids the attempt";
}

std::string firmware_line(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  if (node == nullptr || !node->firmware) return "the firmware differs from the plan";
  return firmware_text(*node->firmware, Firmware::unpacked(event.value));
}

std::string node_line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::axis_not_stopped:
      return axis_stop_text(plan, event);
    case EventKind::still_armed:
      return still_armed_text(event);
    case EventKind::drive_coasts:
      return coasting_text(event);
    case EventKind::boot_started:
      return "boot begins";
    case EventKind::boot_done:
      return boot_done_text(event);
    case EventKind::node_state:
      return "NMT state is " +
             std::string{name(static_cast<NmtState>(static_cast<std::uint8_t>(event.value)))};
    case EventKind::heartbeat_lost:
      return "heartbeat lost: silent for " + time_text(Time{event.value});
    case EventKind::heartbeat_back:
      return "heartbeat is back";
    case EventKind::guarding_lost:
      return "guarding lost: no good answer for " + time_text(Time{event.value});
    case EventKind::guarding_toggle:
      return "a guarding answer has the same toggle bit as the previous answer: the master treats "
             "it as not received (an answer was lost, or another master guards the node too)";
    case EventKind::bootup_again:
      return std::string{
                 "a boot-up message came from a node that was ready: the node has "
                 "restarted, and the master "} +
             (event.value == 0 ? "boots it again" : "does not boot it until it is commanded to");
    case EventKind::lss_assigned:
      return "a device without node id, serial number " + std::to_string(event.value) +
             ", has got this id by LSS";
    case EventKind::lss_not_assigned:
      return lss_trouble_text(plan, event);
    case EventKind::node_replaced:
      return "the device was replaced: its serial number is " + std::to_string(event.value) +
             ", it was " + std::to_string(event.detail) +
             "; with `serial_number` in the network file the master would refuse it";
    case EventKind::firmware_differs:
      return firmware_line(plan, event);
    case EventKind::no_sdo_block:
      return no_block_text(event);
    case EventKind::program_progress:
      return "program download: " + std::to_string(event.value) + " of " +
             std::to_string(event.detail) + " bytes";
    case EventKind::duplicate_node:
      return twin_text(event);
    case EventKind::loss_reaction:
      return "the node was lost: " + reaction_text(event);
    case EventKind::emcy:
      return emcy_line(plan, event);
    case EventKind::pdo_missing:
      return "TPDO" + std::to_string(event.value) + " is missing";
    case EventKind::pdo_back:
      return "TPDO" + std::to_string(event.value) + " is back";
    case EventKind::pdo_late:
      return "TPDO" + std::to_string(event.value) + " comes late: " + std::to_string(event.detail) +
             " us after SYNC, after the synchronous window";
    case EventKind::pdo_length:
      return "TPDO" + std::to_string(event.value) + " has " + std::to_string(event.detail) +
             " bytes, which differs from its mapping";
    case EventKind::outputs_held:
      return held_line(plan, event);
    default:
      return std::string{name(event.kind)};
  }
}

/// The time without a command after which an output takes its fallback, and the key that sets it.
std::string within(const BusPlan& plan, const Event& event) {
  const auto signal = static_cast<std::size_t>(event.value);
  if (signal >= plan.layout.signals.size()) return {};
  const Signal& output = plan.layout.signals[signal];
  const CommandLimit configured{.cycles = output.fallback_cycles};
  const CommandLimit limit = unpack_limit(event.bytes).value_or(configured);
  if (limit.cycles == 0) return {};
  const bool own = limit.origin == LimitOrigin::command;
  if (!own && output.fallback_key == TimeToLiveKey::after_cycles) {
    return " within " + std::to_string(limit.cycles) + " cycles (on_timeout: after_cycles)";
  }
  const auto time = limit.cycles * plan.cycle.period / std::chrono::milliseconds{1};
  return " within " + std::to_string(time) + " ms (" +
         (own ? "time_to_live of the command" : "on_timeout: after") + ")";
}

std::string signal_line(const BusPlan& plan, const Event& event) {
  const std::string signal = signal_name(plan, event.value);
  switch (event.kind) {
    case EventKind::fallback_begun:
      return "no fresh command for " + signal + within(plan, event) + ": its fallback is sent";
    case EventKind::fallback_ended:
      return "fresh commands for " + signal + " again";
    default:
      return std::string{name(event.kind)};
  }
}

bool is_of_node(EventKind kind) noexcept {
  if (is_of_network(kind)) return false;
  return kind <= EventKind::pdo_length || kind == EventKind::outputs_held ||
         kind == EventKind::axis_not_stopped || kind == EventKind::still_armed ||
         kind == EventKind::drive_coasts;
}

std::string line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::fallback_begun:
    case EventKind::fallback_ended:
      return signal_line(plan, event);
    case EventKind::limit_exceeded:
      return limit_text(plan, event);
    case EventKind::limit_read:
      return read_limit_text(plan, event);
    default:
      break;
  }
  return is_of_node(event.kind) ? node_line(plan, event) : bus_event_text(plan, event);
}

}  // namespace

std::string subject(const BusPlan& plan, std::uint8_t node) {
  if (node == 0) return "bus '" + plan.name + "'";
  const NodePlan* const planned = plan.find(node);
  return planned == nullptr ? "node " + std::to_string(int{node}) : node_text(*planned);
}

std::string describe(const BusPlan& plan, const Event& event) {
  if (event.kind == EventKind::boot_failed) {
    std::string text = explain(plan, plan.index_of(event.node), event.failure);
    if (event.detail > 1) {
      text +=
          "\n  repeated  " + std::to_string(event.detail) + " times in a row with the same cause";
    }
    return text;
  }
  return subject(plan, event.node) + ": " + line(plan, event);
}

}  // namespace takt
