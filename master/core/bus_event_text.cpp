#include "master/core/bus_event_text.hpp"

#include <string_view>

#include "master/core/boot_report.hpp"
#include "master/core/bus_trouble.hpp"
#include "master/core/report_text.hpp"

namespace takt {
namespace {

std::string nmt_bytes_text(const Event& event) {
  return hex(event.bytes[0], 2).substr(2) + " " + hex(event.bytes[1], 2).substr(2);
}

std::string missed_line(const Event& event) {
  const std::string count = event.value == 1 ? "1 cycle" : std::to_string(event.value) + " cycles";
  switch (static_cast<MissedBecause>(event.detail)) {
    case MissedBecause::wire_blocked:
      return count +
             " without SYNC: the one before was not on the wire yet, because the controller is "
             "bus-off or nobody acknowledges";
    case MissedBecause::sent_late:
      return count +
             " without SYNC: the bus thread was late in the cycle before, and its SYNC was not on "
             "the wire yet";
    case MissedBecause::not_seen:
      return count +
             " without SYNC: the one before was not seen on the wire yet, although the controller "
             "reports no error; there was too much traffic, or this machine was too busy to send "
             "it or to see it";
    case MissedBecause::late:
      break;
  }
  return count + " missed: the bus thread was late; skipped, not caught up";
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

std::string_view while_lost(std::uint32_t reaction) noexcept {
  switch (static_cast<SyncLoss>(reaction)) {
    case SyncLoss::hold:
      return "no outputs are sent until it is back";
    case SyncLoss::fallback:
      return "outputs take their fallback until it is back, those in synchronous RPDOs by SDO";
    case SyncLoss::stop:
      return "every node but the producer is stopped until it is back";
  }
  return {};
}

std::string_view when_back(std::uint32_t reaction) noexcept {
  switch (static_cast<SyncLoss>(reaction)) {
    case SyncLoss::hold:
      return "outputs are sent again";
    case SyncLoss::fallback:
      return "commands are heard again";
    case SyncLoss::stop:
      return "the nodes are started again";
  }
  return {};
}

/// Describes an event of the SYNC of another device.
std::string sync_line(const BusPlan& plan, const Event& event) {
  const std::string maker =
      plan.cycle.sync_producer ? subject(plan, plan.cycle.sync_producer->value()) : "its producer";
  const Time time{event.value};
  switch (event.kind) {
    case EventKind::sync_lost:
      return (event.value == 0 ? "no SYNC has come" : "SYNC lost: none for " + time_text(time)) +
             "; " + std::string{while_lost(event.detail)} + ". Look at " + maker +
             ": does it run, is its 0x1006 set, and bit 30 of its 0x1005?";
    case EventKind::sync_back:
      return event.value == 0 ? "SYNC is there: the cycle keeps to it"
                              : "SYNC is back after " + time_text(time) + "; " +
                                    std::string{when_back(event.detail)};
    case EventKind::sync_jump:
      return (event.value < 0 ? "SYNC without counter"
                              : "SYNC counter " + std::to_string(event.value)) +
             (event.detail == 0 ? std::string{", but `sync_overflow` says that it has none"}
                                : ", expected " + std::to_string(event.detail)) +
             ": a SYNC was lost, " + maker + " has started again, or its 0x1019 is another";
    case EventKind::sync_early:
      return "a SYNC only " + time_text(time) + " after the one before, in a period of " +
             time_text(plan.cycle.period) + ": it is left out; is there a second producer?";
    default:
      return "SYNC comes each " + time_text(time) + ", but `sync_period` says " +
             time_text(plan.cycle.period) + ": correct the network file, or 0x1006 of " + maker;
  }
}

bool is_of_sync(EventKind kind) noexcept {
  return kind == EventKind::sync_lost || kind == EventKind::sync_back ||
         kind == EventKind::sync_jump || kind == EventKind::sync_early ||
         kind == EventKind::sync_period;
}

std::string missing_mandatory(const BusPlan& plan) {
  std::string names;
  for (const NodePlan& node : plan.nodes) {
    if (node.mandatory) names += (names.empty() ? "" : ", ") + node_text(node);
  }
  return names;
}

std::string network_line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::unlisted_node:
      return "node " + std::to_string(event.value) +
             " is on the bus but not in the network file (status A of CiA 302-2: " +
             std::string{letter_text('A')} + "): add it, or leave it alone; `takt sdo read " +
             std::to_string(event.value) + " 1018:1 u32 --bus " + interface_text(plan) +
             "` tells its vendor";
    case EventKind::network_ready:
      return "the network is ready: every mandatory node has booted";
    case EventKind::network_late:
      return std::to_string(event.detail) +
             " mandatory nodes have not booted within the boot "
             "time of " +
             time_text(plan.start_up.boot_time) + " (mandatory: " + missing_mandatory(plan) +
             "): the master waits for them; their boot reports say why";
    case EventKind::mandatory_lost:
      return event.value == 1 ? "a mandatory node was lost: all nodes are stopped; they stay so "
                                "until they are reset or started (`takt nmt reset all`)"
                              : "a mandatory node was lost: all nodes are reset and boot again";
    default:
      return std::string{name(event.kind)};
  }
}

bool is_of_all_nodes(EventKind kind) noexcept {
  return kind == EventKind::unlisted_node || kind == EventKind::network_ready ||
         kind == EventKind::network_late || kind == EventKind::mandatory_lost;
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

}  // namespace

bool is_of_network(EventKind kind) noexcept { return is_of_all_nodes(kind) || is_of_sync(kind); }

std::string bus_event_text(const BusPlan& plan, const Event& event) {
  if (is_of_all_nodes(event.kind)) return network_line(plan, event);
  return is_of_sync(event.kind) ? sync_line(plan, event) : bus_line(plan, event);
}

}  // namespace takt
