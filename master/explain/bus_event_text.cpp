#include <fmt/format.h>
#include <string_view>
#include <vector>

#include "eds_parser/values/name_of.hpp"
#include "master/core/event.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/event_text.hpp"
#include "master/explain/report_text.hpp"

namespace takt {
namespace {

/// Returns the interface as the subject of a sentence.
std::string interface_name(const BusPlan& plan) {
  return plan.interface.empty() ? "the interface" : plan.interface;
}

std::string missed_line(const Event& event) {
  static constexpr std::string_view causes[]{
      "missed: the bus thread was late; the master skips these cycles and does not make up for "
      "them",
      "without SYNC: the previous SYNC was not on the wire yet, because the controller is bus-off "
      "or no node acknowledges",
      "without SYNC: the bus thread was late in the previous cycle, and the SYNC of that cycle was "
      "not on the wire yet",
      "without SYNC: the previous SYNC was not seen on the wire yet, although the controller "
      "reports no error; there was too much traffic, or this machine was too busy to send the SYNC "
      "or to receive it"};
  return fmt::format("{} {} {}", event.value, event.value == 1 ? "cycle" : "cycles",
                     name_of(static_cast<MissedBecause>(event.detail), causes, causes[0]));
}

std::string send_failure_text(const BusPlan& plan, const Event& event) {
  switch (static_cast<SendFailure>(event.detail)) {
    case SendFailure::bus_off:
      return "the CAN controller is bus-off";
    case SendFailure::nobody_acknowledges:
      return "no node acknowledges on the bus; check the cable, the termination, the bit rate and "
             "the power supply of the devices";
    case SendFailure::queue_too_short:
      break;
  }
  return fmt::format(
      "its queue is too short for the frames of one cycle: `ip link set {} txqueuelen 1000`",
      interface_name(plan));
}

std::string_view while_lost(std::uint32_t reaction) noexcept {
  static constexpr std::string_view names[]{
      "no outputs are sent until SYNC is back",
      "outputs take their fallback until SYNC is back; those in synchronous RPDOs get it by SDO",
      "every node except the SYNC producer is stopped until SYNC is back"};
  return name_of(static_cast<SyncLoss>(reaction), names);
}

std::string_view when_back(std::uint32_t reaction) noexcept {
  static constexpr std::string_view names[]{"the master sends outputs again",
                                            "the master accepts commands again",
                                            "the master starts the nodes again"};
  return name_of(static_cast<SyncLoss>(reaction), names);
}

/// Describes an event of the SYNC of another device.
std::string sync_line(const BusPlan& plan, const Event& event) {
  const std::string producer =
      plan.cycle.sync_producer ? subject(plan, plan.cycle.sync_producer->value()) : "its producer";
  const std::string time = time_text(Time{event.value});
  switch (event.kind) {
    case EventKind::sync_lost:
      return fmt::format(
          "{}; {}. Check {}: does it run, is its 0x1006 set, and bit 30 of its 0x1005?",
          event.value == 0 ? "no SYNC has come" : "SYNC lost: no SYNC for " + time,
          while_lost(event.detail), producer);
    case EventKind::sync_back:
      return event.value == 0
                 ? "SYNC has come: the cycle follows it"
                 : fmt::format("SYNC is back after {}; {}", time, when_back(event.detail));
    case EventKind::sync_jump:
      return fmt::format(
          "{}, {}: a SYNC was lost, {} has restarted, or its 0x1019 differs",
          event.value < 0 ? "SYNC without counter" : fmt::format("SYNC counter {}", event.value),
          event.detail == 0 ? "but `sync_overflow` says that SYNC has no counter"
                            : fmt::format("expected {}", event.detail),
          producer);
    case EventKind::sync_early:
      return fmt::format(
          "a SYNC came only {} after the previous one, in a period of {}: the master ignores it; "
          "is there a second SYNC producer?",
          time, time_text(plan.cycle.period));
    case EventKind::sync_period:
      return fmt::format(
          "SYNC comes every {}, but `sync_period` says {}: correct the network file, or 0x1006 of "
          "{}",
          time, time_text(plan.cycle.period), producer);
    default:
      return {};
  }
}

std::string mandatory_nodes(const BusPlan& plan) {
  std::vector<std::string> names;
  for (const NodePlan& node : plan.nodes) {
    if (node.mandatory) names.push_back(node_text(node));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string bus_line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::unlisted_node:
      return fmt::format(
          "node {0} is on the bus but not in the network file (status A of CiA 302-2: {1}): add "
          "the node to the file, or ignore it; `takt sdo read {0} 1018:1 u32 --bus {2}` shows its "
          "vendor",
          event.value, letter_text('A'), interface_text(plan));
    case EventKind::network_ready:
      return "the network is ready: every mandatory node has booted";
    case EventKind::network_late:
      return fmt::format(
          "{} mandatory nodes did not boot within the boot time of {} (mandatory: {}): the master "
          "waits for them; their boot reports give the causes",
          event.detail, time_text(plan.start_up.boot_time), mandatory_nodes(plan));
    case EventKind::mandatory_lost:
      return event.value == 1 ? "a mandatory node was lost: all nodes are stopped; they stay in "
                                "STOPPED until they are reset or started (`takt nmt reset all`)"
                              : "a mandatory node was lost: all nodes are reset and boot again";
    case EventKind::cycles_missed:
      return missed_line(event);
    case EventKind::receive_overrun:
      return fmt::format("{} received frames were lost in the kernel", event.value);
    case EventKind::bus_error_passive:
      return "the CAN controller is error-passive: check the cable, the termination and the bit "
             "rate";
    case EventKind::bus_error_active:
      return "the CAN controller is error-active again";
    case EventKind::bus_off:
      return fmt::format(
          "bus-off: the CAN controller has switched itself off; with `ip link set {} type can "
          "restart-ms 100` it restarts by itself",
          interface_name(plan));
    case EventKind::bus_recovered:
      return "the CAN controller has recovered from bus-off";
    case EventKind::send_buffer_full:
      return fmt::format("{} frames were not sent, because the send buffer is full (ENOBUFS): {}",
                         event.value, send_failure_text(plan, event));
    case EventKind::interface_down:
      return fmt::format("{} is down (error {})", interface_name(plan), event.detail);
    case EventKind::interface_up:
      return fmt::format("{} is up", interface_name(plan));
    case EventKind::foreign_sync:
      return "a SYNC came that this master did not send: there is a second SYNC producer on the "
             "bus";
    case EventKind::foreign_nmt:
      return fmt::format(
          "NMT command {} came that this master did not send: there is a second master on the bus",
          bytes_text(std::span{event.bytes}.first(2)));
    case EventKind::duplicate_cob_id:
      return fmt::format(
          "COB-ID 0x{:03X} is also sent by another node: do two nodes have the same id?",
          static_cast<std::uint32_t>(event.value));
    default:
      return std::string{name(event.kind)};
  }
}

}  // namespace

std::string bus_event_text(const BusPlan& plan, const Event& event) {
  std::string line = sync_line(plan, event);
  return line.empty() ? bus_line(plan, event) : line;
}

}  // namespace takt
