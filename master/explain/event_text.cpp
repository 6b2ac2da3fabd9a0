#include "master/explain/event_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "eds_parser/table/pdo_table.hpp"
#include "master/core/command_limit.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/emcy_text.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::string signal_name(const BusPlan& plan, std::int64_t index) {
  const auto& signals = plan.layout.signals;
  if (index < 0 || static_cast<std::size_t>(index) >= signals.size()) {
    return fmt::format("signal {}", index);
  }
  const Signal& signal = signals[static_cast<std::size_t>(index)];
  return fmt::format("{} ({})", signal.name, to_string(signal.object));
}

/// Returns a text that names the TPDO with an actual position, and says how to make the device send
/// it soon.
std::string first_time_text(const BusPlan& plan, SignalIndex signal) {
  const PdoRow* const pdo = tpdo_of(plan.pdos, signal);
  if (pdo == nullptr) return {};
  if (!comes_by_event_alone(*pdo)) {
    return fmt::format("; check whether the device sends TPDO{}", pdo->number);
  }
  return fmt::format(
      "; the device sends TPDO{} only by event: give the TPDO an `event_timer`, or make it "
      "synchronous (`transmission: 1`)",
      pdo->number);
}

std::string held_line(const BusPlan& plan, const Event& event) {
  const std::string held = fmt::format("RPDO{} is held back until ", event.value);
  if (event.detail == 0)
    return held + "each of its signals has a value from a command, the network file or the device";
  const auto awaited = static_cast<SignalIndex>(event.detail - 1);
  return fmt::format(
      "{}{} has come from the device for the first time: takt checks the first position command "
      "with `limits:` against this value{}",
      held, signal_name(plan, awaited), first_time_text(plan, awaited));
}

std::string emcy_line(const BusPlan& plan, const Event& event) {
  const std::size_t length = event.detail == 0 ? 8 : std::min<std::size_t>(event.detail, 8);
  const std::span bytes{event.bytes};
  std::string text = "EMCY of 1 byte, too short for an error code (bytes";
  if (length > 1) {
    const auto code = load_le<std::uint16_t>(bytes);
    text = fmt::format("EMCY {}: {} (", hex(code), emcy_text(plan.find(event.node), code));
    if (length > 2) text += fmt::format("error register: {}; ", error_register_text(bytes[2]));
    text += "bytes";
  }
  text += fmt::format(" {}{}", bytes_text(bytes.first(length)), length == 8 ? ")" : ", always 8)");
  if (event.value > 0) text += fmt::format("; {} earlier ones were not reported", event.value);
  return text;
}

std::string boot_done_text(const Event& event) {
  std::string text = fmt::format("ready after {} ms", event.detail);
  if (event.value != 1) return text;
  text += "; the node was operational already and was not reset (status L of CiA 302-2)";
  const auto left_alone = load_le<std::uint16_t>(std::span{event.bytes});
  if (left_alone == 0) return text;
  const ObjectKey first{load_le<std::uint16_t>(std::span{event.bytes}.subspan(2)), event.bytes[4]};
  return fmt::format("{}; {} {} from the network file until the node is reset, the first is {}",
                     text, left_alone, left_alone == 1 ? "object differs" : "objects differ",
                     to_string(first));
}

std::string duplicate_node_text(const Event& event) {
  const bool answers = event.value == static_cast<std::int64_t>(DuplicateSign::answers);
  return fmt::format(
      "{}; switch one device off, or give it another id (`takt lss`)",
      answers ? "several answers came to each SDO request: two devices have this node id, or "
                "another SDO client uses the server"
              : "twice as many heartbeats came as one device sends: two devices have this node id");
}

std::string lss_failure_text(const BusPlan& plan, const Event& event) {
  const LssResult result{.op = static_cast<LssOp>(event.bytes[0]),
                         .outcome = static_cast<LssOutcome>(event.bytes[1]),
                         .error = event.bytes[2],
                         .specific = event.bytes[3]};
  const NodePlan* const node = plan.find(event.node);
  if (result.outcome == LssOutcome::nobody && node != nullptr && node->lss) {
    return fmt::format(
        "a device without node id answers LSS, but no such device has {}, which the network file "
        "gives this node: `takt lss find` shows the devices without node id",
        identity_text(*node->lss));
  }
  return "a device without node id is on the bus, but LSS failed: " + lss_failure_text(result);
}

std::string no_block_text(const Event& event) {
  const auto object = to_string(ObjectKey{static_cast<std::uint16_t>(event.detail >> 8U),
                                          static_cast<std::uint8_t>(event.detail)});
  const std::string abort = abort_digits(static_cast<std::uint32_t>(event.value));
  return fmt::format(
      "{}: the master uses segmented transfer for this and all other values until the node is "
      "reset; `sdo_block: never` of this node avoids the attempt",
      event.value == 0 ? fmt::format("gives no answer to SDO block transfer ({})", object)
                       : fmt::format("refuses SDO block transfer ({}, {})", object, abort));
}

/// Returns a text for a device with another firmware than the one for which its device data were
/// made. It states the consequences and what the user can write in the network file.
std::string firmware_line(const BusPlan& plan, const Event& event) {
  const NodePlan* const node = plan.find(event.node);
  if (node == nullptr || !node->firmware) return "the firmware differs from the plan";
  const Firmware is = Firmware::unpacked(event.value);
  const Firmware& assumed = node->firmware->assumed;
  std::string consequences;
  for (const FirmwareRule& rule : node->firmware->rules) {
    if (rule.holds(is) == rule.holds(assumed)) continue;
    consequences += fmt::format("{}{}{}", consequences.empty() ? "" : "; ",
                                rule.holds(is) ? "" : "not valid for this firmware: ", rule.text);
  }
  if (consequences.empty()) consequences = "nothing in the device data depends on this difference";
  return fmt::format(
      "the firmware is {0} ({1}), but the plan assumes {2}: {3}. Write `firmware: \"{0}\"` for "
      "this node, and check the plan with `takt plan`",
      to_string(is), to_string(node->firmware->object), to_string(assumed), consequences);
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
      return fmt::format("NMT state is {}",
                         name(static_cast<NmtState>(static_cast<std::uint8_t>(event.value))));
    case EventKind::heartbeat_lost:
      return fmt::format("heartbeat lost: silent for {}", time_text(Time{event.value}));
    case EventKind::heartbeat_back:
      return "heartbeat is back";
    case EventKind::guarding_lost:
      return fmt::format("guarding lost: no valid answer for {}", time_text(Time{event.value}));
    case EventKind::guarding_toggle:
      return "a guarding answer has the same toggle bit as the previous answer: the master treats "
             "it as not received (an answer was lost, or another master guards the node too)";
    case EventKind::bootup_again:
      return fmt::format(
          "a boot-up message came from a node that was ready: the node has restarted, and the "
          "master {}",
          event.value == 0 ? "boots it again" : "does not boot it until it is commanded to");
    case EventKind::lss_assigned:
      return fmt::format("a device without node id, serial number {}, has got this id by LSS",
                         event.value);
    case EventKind::lss_not_assigned:
      return lss_failure_text(plan, event);
    case EventKind::node_replaced:
      return fmt::format(
          "the device was replaced: its serial number is {}, it was {}; with `serial_number` in "
          "the network file the master would refuse it",
          event.value, event.detail);
    case EventKind::firmware_differs:
      return firmware_line(plan, event);
    case EventKind::no_sdo_block:
      return no_block_text(event);
    case EventKind::program_progress:
      return fmt::format("program download: {} of {} bytes", event.value, event.detail);
    case EventKind::duplicate_node:
      return duplicate_node_text(event);
    case EventKind::loss_reaction:
      return "the node was lost: " + reaction_text(event);
    case EventKind::emcy:
      return emcy_line(plan, event);
    case EventKind::pdo_missing:
      return fmt::format("TPDO{} is missing", event.value);
    case EventKind::pdo_back:
      return fmt::format("TPDO{} is back", event.value);
    case EventKind::pdo_late:
      return fmt::format("TPDO{} comes late: {} us after SYNC, after the synchronous window",
                         event.value, event.detail);
    case EventKind::pdo_length:
      return fmt::format("TPDO{} has {} bytes, which differs from its mapping", event.value,
                         event.detail);
    case EventKind::outputs_held:
      return held_line(plan, event);
    default:
      return {};
  }
}

/// Returns the time without a command after which an output takes its fallback, and the key that
/// sets this time.
std::string within(const BusPlan& plan, const Event& event) {
  const auto signal = static_cast<std::size_t>(event.value);
  if (signal >= plan.layout.signals.size()) return {};
  const Signal& output = plan.layout.signals[signal];
  const CommandLimit configured{.cycles = output.fallback_cycles};
  const CommandLimit limit = unpack_limit(event.bytes).value_or(configured);
  if (limit.cycles == 0) return {};
  const bool own = limit.origin == LimitOrigin::command;
  if (!own && output.fallback_key == TimeToLiveKey::after_cycles) {
    return fmt::format(" within {} cycles (on_timeout: after_cycles)", limit.cycles);
  }
  return fmt::format(" within {} ms ({})",
                     limit.cycles * plan.cycle.period / std::chrono::milliseconds{1},
                     own ? "time_to_live of the command" : "on_timeout: after");
}

std::string output_line(const BusPlan& plan, const Event& event) {
  switch (event.kind) {
    case EventKind::fallback_begun:
      return fmt::format("no fresh command for {}{}: its fallback is sent",
                         signal_name(plan, event.value), within(plan, event));
    case EventKind::fallback_ended:
      return fmt::format("fresh commands for {} have come: they are sent again",
                         signal_name(plan, event.value));
    case EventKind::limit_exceeded:
      return limit_text(plan, event);
    case EventKind::limit_read:
      return read_limit_text(plan, event);
    default:
      return {};
  }
}

}  // namespace

std::string subject(const BusPlan& plan, std::uint8_t node) {
  if (node == 0) return fmt::format("bus '{}'", plan.name);
  const NodePlan* const planned = plan.find(node);
  return planned == nullptr ? fmt::format("node {}", node) : node_text(*planned);
}

std::string describe(const BusPlan& plan, const Event& event) {
  if (event.kind == EventKind::boot_failed) {
    std::string text = explain(plan, plan.index_of(event.node), event.failure);
    if (event.detail > 1) {
      text += fmt::format("\n  repeated  {} times in a row with the same cause", event.detail);
    }
    return text;
  }
  std::string line = node_line(plan, event);
  if (line.empty()) line = output_line(plan, event);
  if (line.empty()) line = bus_event_text(plan, event);
  return fmt::format("{}: {}", subject(plan, event.node), line);
}

}  // namespace takt
