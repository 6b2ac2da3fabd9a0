#include "master/explain/bus_event_text.hpp"

#include <string_view>

#include "eds_parser/table/name_of.hpp"
#include "master/core/event.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/report_text.hpp"

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
             " without SYNC: the previous SYNC was not on the wire yet, because the controller is "
             "bus-off or no node acknowledges";
    case MissedBecause::sent_late:
      return count +
             " without SYNC: the bus thread was late in the previous cycle, and the SYNC of that "
             "cycle was not on the wire yet";
    case MissedBecause::not_seen:
      return count +
             " without SYNC: the previous SYNC was not seen on the wire yet, although the "
             "controller reports no error; there was too much traffic, or this machine was too "
             "busy to send the SYNC or to receive it";
    case MissedBecause::late:
      break;
  }
  return count +
         " missed: the bus thread was late; the master skips these cycles and does not make up for "
         "them";
}

std::string send_trouble_text(const Event& event, const std::string& interface) {
  switch (static_cast<SendTrouble>(event.detail)) {
    case SendTrouble::bus_off:
      return "the CAN controller is bus-off";
    case SendTrouble::nobody_acknowledges:
      return "no node acknowledges on the bus; check the cable, the termination, the bit rate and "
             "the power supply of the devices";
    case SendTrouble::queue_too_short:
      break;
  }
  return "its queue is too short for the frames of one cycle: `ip link set " + interface +
         " txqueuelen 1000`";
}

std::string_view while_lost(std::uint32_t reaction) noexcept {
  switch (static_cast<SyncLoss>(reaction)) {
    case SyncLoss::hold:
      return "no outputs are sent until SYNC is back";
    case SyncLoss::fallback:
      return "outputs take their fallback until SYNC is back; those in synchronous RPDOs get it by "
             "SDO";
    case SyncLoss::stop:
      return "every node except the SYNC producer is stopped until SYNC is back";
  }
  return {};
}

std::string_view when_back(std::uint32_t reaction) noexcept {
  static constexpr std::string_view names[]{"the master sends outputs again",
                                            "the master accepts commands again",
                                            "the master starts the nodes again"};
  return name_of(static_cast<SyncLoss>(reaction), names);
}

/// Describes an event of the SYNC of another device.
std::string sync_line(const BusPlan& plan, const Event& event) {
  const std::string maker =
      plan.cycle.sync_producer ? subject(plan, plan.cycle.sync_producer->value()) : "its producer";
  const Time time{event.value};
  switch (event.kind) {
    case EventKind::sync_lost:
      return (event.value == 0 ? "no SYNC has come" : "SYNC lost: no SYNC for " + time_text(time)) +
             "; " + std::string{while_lost(event.detail)} + ". Check " + maker +
             ": does it run, is its 0x1006 set, and bit 30 of its 0x1005?";
    case EventKind::sync_back:
      return event.value == 0 ? "SYNC has come: the cycle follows it"
                              : "SYNC is back after " + time_text(time) + "; " +
                                    std::string{when_back(event.detail)};
    case EventKind::sync_jump:
      return (event.value < 0 ? "SYNC without counter"
                              : "SYNC counter " + std::to_string(event.value)) +
             (event.detail == 0 ? std::string{", but `sync_overflow` says that SYNC has no counter"}
                                : ", expected " + std::to_string(event.detail)) +
             ": a SYNC was lost, " + maker + " has restarted, or its 0x1019 differs";
    case EventKind::sync_early:
      return "a SYNC came only " + time_text(time) + " after the previous one, in a period of " +
             time_text(plan.cycle.period) +
             ": the master ignores it; is there a second SYNC producer?";
    default:
      return "SYNC comes every " + time_text(time) + ", but `sync_period` says " +
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
             std::string{letter_text('A')} +
             "): add the node to the file, or ignore it; `takt sdo read " +
             std::to_string(event.value) + " 1018:1 u32 --bus " + interface_text(plan) +
             "` shows its vendor";
    case EventKind::network_ready:
      return "the network is ready: every mandatory node has booted";
    case EventKind::network_late:
      return std::to_string(event.detail) +
             " mandatory nodes did not boot within the boot time of " +
             time_text(plan.start_up.boot_time) + " (mandatory: " + missing_mandatory(plan) +
             "): the master waits for them; their boot reports give the causes";
    case EventKind::mandatory_lost:
      return event.value == 1 ? "a mandatory node was lost: all nodes are stopped; they stay in "
                                "STOPPED until they are reset or started (`takt nmt reset all`)"
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
      return count + " received frames were lost in the kernel";
    case EventKind::bus_error_passive:
      return "the CAN controller is error-passive: check the cable, the termination and the bit "
             "rate";
    case EventKind::bus_error_active:
      return "the CAN controller is error-active again";
    case EventKind::bus_off:
      return "bus-off: the CAN controller has switched itself off; with `ip link set " + interface +
             " type can restart-ms 100` it restarts by itself";
    case EventKind::bus_recovered:
      return "the CAN controller has recovered from bus-off";
    case EventKind::send_buffer_full:
      return count + " frames were not sent, because the send buffer is full (ENOBUFS): " +
             send_trouble_text(event, interface);
    case EventKind::interface_down:
      return interface + " is down (error " + std::to_string(event.detail) + ")";
    case EventKind::interface_up:
      return interface + " is up";
    case EventKind::foreign_sync:
      return "a SYNC came that this master did not send: there is a second SYNC producer on the "
             "bus";
    case EventKind::foreign_nmt:
      return "NMT command " + nmt_bytes_text(event) +
             " came that this master did not send: there is a second master on the bus";
    case EventKind::duplicate_cob_id:
      return "COB-ID " + hex(static_cast<std::uint32_t>(event.value), 3) +
             " is also sent by another node: do two nodes have the same id?";
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
