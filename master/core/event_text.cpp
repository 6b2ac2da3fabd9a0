#include <algorithm>
#include <string>

#include "master/core/boot_report.hpp"
#include "master/core/bus_trouble.hpp"
#include "master/core/report_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/emcy_text.hpp"

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

std::string_view reason(std::uint32_t detail) noexcept {
  switch (static_cast<RefusedBecause>(detail)) {
    case RefusedBecause::not_an_output:
      return "it is not an output";
    case RefusedBecause::other_session:
      return "another sender holds the outputs of this node";
    case RefusedBecause::stale_session:
      return "it was made for an earlier run of the daemon (a replayed log?)";
    case RefusedBecause::node_not_ready:
      return "the node is not ready";
    case RefusedBecause::out_of_range:
      return "the value does not fit the object";
    case RefusedBecause::observing:
      return "the master only observes";
  }
  return "of an unknown reason";
}

std::string_view emcy_meaning(const BusPlan& plan, std::uint8_t node, std::uint16_t code) {
  const auto found =
      std::ranges::find(plan.nodes, node, [](const NodePlan& one) { return one.id.value(); });
  if (found == plan.nodes.end()) return emcy_text(code);
  const auto own = std::ranges::find(found->emcy_texts, code, &EmcyText::code);
  return own == found->emcy_texts.end() ? emcy_text(code) : std::string_view{own->text};
}

std::string emcy_line(const BusPlan& plan, const Event& event) {
  const std::span bytes{event.bytes};
  const auto code = load_le<std::uint16_t>(bytes);
  std::string text = "EMCY " + hex(code) + ": " +
                     std::string{emcy_meaning(plan, event.node, code)} +
                     " (error register: " + error_register_text(bytes[2]) + "; bytes";
  for (const std::uint8_t byte : bytes) text += " " + hex(byte, 2).substr(2);
  text += ")";
  if (event.value > 0) text += "; " + std::to_string(event.value) + " before it were not told";
  return text;
}

std::string nmt_bytes_text(const Event& event) {
  return hex(event.bytes[0], 2).substr(2) + " " + hex(event.bytes[1], 2).substr(2);
}

std::string node_line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::boot_started:
      return "boot begins";
    case EventKind::boot_done:
      return "ready after " + std::to_string(event.detail) + " ms" +
             (event.value == 1 ? "; it was operational already and was not reset" : "");
    case EventKind::node_state:
      return "NMT state is " +
             std::string{name(static_cast<NmtState>(static_cast<std::uint8_t>(event.value)))};
    case EventKind::heartbeat_lost:
      return "heartbeat lost: silent for " + time_text(Time{event.value});
    case EventKind::heartbeat_back:
      return "heartbeat is back";
    case EventKind::bootup_again:
      return "boot-up message of a node that was ready: it has restarted and is booted again";
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
             " bytes, which is not what its mapping says";
    case EventKind::outputs_held:
      return "RPDO" + std::to_string(event.value) +
             " is held back until each of its signals has a commanded, safe or seeded value";
    default:
      return std::string{name(event.kind)};
  }
}

std::string signal_line(const BusPlan& plan, const Event& event) {
  const std::string signal = signal_name(plan, event.value);
  switch (event.kind) {
    case EventKind::command_refused:
      return "command to " + signal + " refused: " + std::string{reason(event.detail)};
    case EventKind::fallback_begun:
      return "no fresh command for " + signal + ": its fallback is sent";
    case EventKind::fallback_ended:
      return "fresh commands for " + signal + " again";
    default:
      return std::string{name(event.kind)};
  }
}

std::string missed_line(const Event& event) {
  const std::string count = std::to_string(event.value);
  if (event.detail == static_cast<std::uint32_t>(MissedBecause::wire_blocked)) {
    return count +
           " cycles without SYNC: the one before was not on the wire yet (bus-off, nobody "
           "acknowledges, or too much traffic)";
  }
  return count + " cycles missed: the bus thread was late; they are skipped, not caught up";
}

std::string send_trouble_text(const Event& event, const std::string& interface) {
  switch (static_cast<SendTrouble>(event.detail)) {
    case SendTrouble::bus_off:
      return "the CAN controller is bus-off";
    case SendTrouble::nobody_acknowledges:
      return "nobody acknowledges on the bus; check cable, termination, bit rate, and whether any "
             "device has power";
    case SendTrouble::queue_too_short:
      break;
  }
  return "its queue is shorter than what one cycle sends: `ip link set " + interface +
         " txqueuelen 1000`";
}

std::string bus_line(const BusPlan& plan, const Event& event) {
  const std::string count = std::to_string(event.value);
  const std::string interface = plan.interface.empty() ? "the interface" : plan.interface;
  switch (event.kind) {
    case EventKind::cycles_missed:
      return missed_line(event);
    case EventKind::receive_overrun:
      return count + " received frames lost by the kernel";
    case EventKind::bus_error_passive:
      return "CAN controller is error-passive: check cable, termination and bit rate";
    case EventKind::bus_error_active:
      return "CAN controller is error-active again";
    case EventKind::bus_off:
      return "bus-off: the CAN controller has switched itself off; `ip link set " + interface +
             " type can restart-ms 100` lets it come back";
    case EventKind::bus_recovered:
      return "recovered from bus-off";
    case EventKind::send_buffer_full:
      return count + " frames not sent, the send buffer is full (ENOBUFS): " +
             send_trouble_text(event, interface);
    case EventKind::interface_down:
      return interface + " is down (error " + std::to_string(event.detail) + ")";
    case EventKind::interface_up:
      return interface + " is up";
    case EventKind::foreign_sync:
      return "a SYNC that this master did not send: there is a second SYNC producer on the bus";
    case EventKind::foreign_nmt:
      return "NMT command " + nmt_bytes_text(event) +
             " that this master did not send: there is a second master on the bus";
    case EventKind::duplicate_cob_id:
      return "COB-ID " + hex(static_cast<std::uint32_t>(event.value), 3) +
             " is also sent by somebody else: two nodes with one id?";
    case EventKind::stopping:
      return "stopping";
    case EventKind::stopped:
      return "stopped";
    default:
      return std::string{name(event.kind)};
  }
}

std::string line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::command_refused:
    case EventKind::fallback_begun:
    case EventKind::fallback_ended:
      return signal_line(plan, event);
    default:
      break;
  }
  return event.kind <= EventKind::pdo_length || event.kind == EventKind::outputs_held
             ? node_line(plan, event)
             : bus_line(plan, event);
}

}  // namespace

std::string subject(const BusPlan& plan, std::uint8_t node) {
  if (node == 0) return "bus '" + plan.name + "'";
  const auto found =
      std::ranges::find(plan.nodes, node, [](const NodePlan& each) { return each.id.value(); });
  if (found == plan.nodes.end()) return "node " + std::to_string(int{node});
  return node_text(*found);
}

std::string describe(const BusPlan& plan, const Event& event) {
  if (event.kind == EventKind::boot_failed) {
    const auto found = std::ranges::find(plan.nodes, event.node,
                                         [](const NodePlan& node) { return node.id.value(); });
    std::string text =
        explain(plan, static_cast<std::size_t>(found - plan.nodes.begin()), event.failure);
    if (event.detail > 1) {
      text += "\n  repeated  " + std::to_string(event.detail) + " times in a row by the same cause";
    }
    return text;
  }
  return subject(plan, event.node) + ": " + line(plan, event);
}

}  // namespace takt
