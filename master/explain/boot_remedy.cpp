#include "master/explain/boot_remedy.hpp"

#include <fmt/format.h>

#include "master/core/request.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

/// Returns the advice for a node that gets its node-ID by LSS and has given no sign of life.
std::string against_missing_id(const BusPlan& plan, const NodePlan& node) {
  return fmt::format(
      "node {} has sent nothing. LSS (`lss: true`) assigns this id to a device without node id "
      "that has {}: `takt lss find` shows the devices without node id. If the device there has "
      "another address, correct the network file; if no device is there, `takt scan` shows whether "
      "the device has another node id already. If the log says that the device has got this id, a "
      "reset of all nodes (`takt nmt reset-comm all`) or a power cycle may be needed before the "
      "device uses the id. Otherwise: is the device powered and wired, is its bit rate {} kbit/s, "
      "does the device support LSS fastscan?",
      node.id.value(), identity_text(*node.lss), plan.bitrate / 1000);
}

/// Returns a hint at the SDO channel of the network file, which may be the reason why not even a
/// first answer has come.
std::string about_channel(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  const SdoChannel used = node.sdo.channel_of(node.id);
  if (failure.letter != 'B' || used == default_sdo_channel(node.id)) return {};
  return fmt::format(
      " The master used the SDO channel of `sdo_channel` ({} and {}): the device may lack this SDO "
      "server, or have it switched off or on other COB-IDs (`takt sdo read {} 1201:01 --bus {}` "
      "uses the default channel). Without `sdo_channel` the boot uses the default channel",
      to_string(used.request), to_string(used.answer), node.id.value(), interface_text(plan));
}

/// Returns the last reset before the failed step if the node has answered in this boot before this
/// reset, but not after this reset. Otherwise returns nullptr.
const BootStep* reset_of_a_node_that_was_there(const NodePlan& node, const BootFailure& failure) {
  const auto& steps = node.boot_plan.steps;
  const BootStep* reset = nullptr;
  bool answered = false;
  for (std::size_t i = 0; i < steps.size() && i < failure.step; ++i) {
    const bool is_reset =
        steps[i].action == BootAction::nmt && (steps[i].command == NmtCommand::reset_node ||
                                               steps[i].command == NmtCommand::reset_communication);
    if (is_reset && answered) reset = &steps[i];
    if (steps[i].action != BootAction::probe) continue;
    answered = true;
    reset = nullptr;
  }
  return reset;
}

std::string remedy_for_silence(const BusPlan& plan, const NodePlan& node,
                               const BootFailure& failure) {
  const BootStep* const reset = reset_of_a_node_that_was_there(node, failure);
  if (failure.node_state == NmtState::unknown && reset != nullptr) {
    return fmt::format(
        "the node answered before, but has sent nothing since NMT reset {} ({}): does it need "
        "longer to start (raise `boot_timeout_ms`), or does it have another node id now (`takt "
        "scan`)? Otherwise switch it off and on",
        reset->command == NmtCommand::reset_node ? "node" : "communication", reset->purpose);
  }
  const std::string channel = about_channel(plan, node, failure);
  if (failure.node_state == NmtState::unknown && node.lss) {
    return against_missing_id(plan, node) + channel;
  }
  if (failure.node_state == NmtState::unknown) {
    return fmt::format(
        "node {0} has sent nothing: is it powered and wired (CAN_H, CAN_L, ground, 120 ohm at both "
        "ends of the line)? Is its node id {0} and its bit rate {1} kbit/s? `takt dump --bus {2}` "
        "shows which nodes send on the bus{3}{4}",
        node.id.value(), plan.bitrate / 1000, interface_text(plan), channel.empty() ? "" : ".",
        channel);
  }
  if (failure.node_state == NmtState::stopped) {
    return "the node is in NMT state STOPPED and answers no SDO in this state: let the boot reset "
           "the node (`reset: communication`), or find out which other master stops it";
  }
  return fmt::format(
      "the node is alive on the bus, but its SDO server does not answer{} does it need longer to "
      "start (raise `boot_timeout_ms` of the node)? Is a second node or a second master using node "
      "id {}?",
      channel.empty() ? ":" : "." + channel + ". Otherwise:", node.id.value());
}

std::string against_identity(const NodePlan& node, const BootFailure& failure) {
  if (failure.letter == 'N') {
    return "the device has another firmware or hardware revision than " + node.description_file +
           ": use the EDS of this revision, or drop `revision_number` from the network file if the "
           "difference does not matter";
  }
  if (failure.letter == 'O') {
    return "a device of the same type with another serial number is connected: enter this serial "
           "number in the network file, or drop `serial_number` there";
  }
  const char* const key = failure.letter == 'C'   ? "device_type"
                          : failure.letter == 'D' ? "vendor_id"
                                                  : "product_code";
  return fmt::format(
      "a device other than the configured one answers at node id {}: check the node ids and the "
      "wiring, name the EDS of the connected device instead of {}, or correct `{}` where the "
      "network file gives it",
      node.id.value(), node.description_file, key);
}

std::string against_mismatch(const NodePlan& node, const BootStep& step,
                             const BootFailure& failure) {
  if (failure.letter == 'C' || failure.letter == 'D' || failure.letter >= 'M') {
    return against_identity(node, failure);
  }
  if (step.action == BootAction::verify) {
    return "the device accepted the write but holds another value (it rounds, limits or ignores "
           "it): enter the value that the device keeps in the network file";
  }
  return "the device holds another value in " + to_string(failure.object) +
         " than the network file expects: correct the device or the network file";
}

/// Returns true if the device has accepted a block download and has then become silent. CiA 301,
/// 7.2.4.3.9.
bool accepted_block(const BootFailure& failure) noexcept {
  return failure.received_size != 0 && (failure.received[0] & 0xE3) == 0xA0;
}

constexpr std::uint16_t sync_length_emcy = 0x8240;

/// Returns the advice if a SYNC came before 0x1019 was written. Some stacks keep this error until
/// their next reset.
std::string against_counter() {
  return "a SYNC with counter reached the device before 0x1019 was written (EMCY 0x8240), and this "
         "error keeps the device out of OPERATIONAL; the next try may succeed. Let the device "
         "store 0x1019 (`store_configuration: 1` of this node), or switch the counter off "
         "(`sync_overflow: 0`)";
}

/// Returns the advice for an endless sequence of segments, or for a value that is longer than any
/// object that a boot reads.
std::string against_long_answer(const BootStep& step, const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  if (!step.value.empty() && step.value.size() < request_bytes) {
    return fmt::format(
        "the device sends more than {} bytes for {}, which has {}: its SDO server is faulty. Look "
        "for other firmware, or leave the object out of the network file",
        request_bytes, object, step.value.size());
  }
  return fmt::format("{} is longer than {} bytes: remove it from the network file", object,
                     request_bytes);
}

/// Returns the advice for an answer with fewer bytes than its command specifier needs, else an
/// empty text. CiA 301, 7.2.4.3.1 demands eight bytes.
std::string against_short_answer(const BootFailure& failure) {
  const Frame frame{.id = {}, .length = failure.received_size, .data = failure.received};
  const bool empty = frame.length == 0 && failure.empty_answer;
  if (!empty && (frame.length == 0 || frame.length >= sdo_answer_bytes(frame))) return {};
  return fmt::format(
      "the device answers with {}: its SDO server is faulty. Look for other firmware, or for "
      "an adapter or a gateway that cuts the frames",
      empty ? "an empty frame instead of 8 bytes"
            : fmt::format("{} bytes instead of 8, so that a part of the answer is missing",
                          frame.length));
}

/// Returns true if the device has answered a request after its time-out.
bool was_late(const NodePlan& node, const BootFailure& failure) noexcept {
  return failure.late > node.sdo_timeout && node.sdo_timeout > Time{};
}

/// Returns true if late answers explain the failure. Late answers do not explain it if the device
/// has sent nothing for longer than its latest answer has taken, because the device is then silent.
bool is_late(const NodePlan& node, const BootFailure& failure) noexcept {
  return was_late(node, failure) && failure.quiet <= failure.late;
}

/// Returns a sentence about late answers that came before the device became silent.
std::string about_earlier_lateness(const NodePlan& node, const BootFailure& failure) {
  if (!was_late(node, failure)) return {};
  return fmt::format(
      " Before that, the device has answered a request after {}: raise `sdo_timeout_ms` of this "
      "node, too, which is {} now",
      time_text(failure.late), time_text(node.sdo_timeout));
}

/// Returns the advice for a server that answers late, with too few bytes, or with another object
/// than the requested one.
std::string against_odd_answers(const NodePlan& node, const BootFailure& failure) {
  if (is_late(node, failure)) {
    return fmt::format(
        "the device answers after {}: raise `sdo_timeout_ms` of this node, which is {} now",
        time_text(failure.late), time_text(node.sdo_timeout));
  }
  if (const std::string cut = against_short_answer(failure); !cut.empty()) return cut;
  if (!failure.answered) return {};
  return fmt::format(
      "the device answers with {} where {} was requested: its SDO server is faulty (look for other "
      "firmware), or a second SDO client uses this server at the same time (stop other masters and "
      "tools)",
      to_string(*failure.answered), to_string(failure.object));
}

/// Returns the advice for an answer that breaks the protocol, so that the master has ended the
/// transfer.
std::string against_protocol_error(const BootFailure& failure) {
  const std::string other =
      ". Or a second SDO client uses this server at the same time (stop other masters and tools)";
  if (failure.abort_code == abort_code::toggle_not_alternated) {
    return "the device does not alternate the toggle bit of its segments, so a segment may be lost "
           "or come twice; the master has ended the transfer. The SDO server is faulty with values "
           "of more than 4 bytes: look for other firmware, or leave the object out of the network "
           "file" +
           other;
  }
  if (failure.abort_code == abort_code::command_unknown) {
    return "the answer has a command specifier that does not belong to the request; the master has "
           "ended the transfer. The SDO server of the device is faulty: look for other firmware" +
           other;
  }
  return "the answers break the SDO protocol, and the master has ended the transfer: the SDO "
         "server of the device is faulty" +
         other + ", or two nodes have the same node id";
}

std::string against_timeout(const BusPlan& plan, const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  switch (step.action) {
    case BootAction::await_heartbeat:
      return failure.node_state == NmtState::unknown || failure.node_state == NmtState::bootup
                 ? "the device produces no heartbeat: is 0x1017 zero after the boot? Set "
                   "`heartbeat_producer` of this node in ms; with 0 the master expects no heartbeat"
                 : "the heartbeat is slower than expected: raise `heartbeat_multiplier` or lower "
                   "`heartbeat_producer` of this node";
    case BootAction::await_guarding:
      return "the device does not answer guarding requests (remote frames): set `guard_time: 0` of "
             "this node, or `heartbeat_producer` if the device has 1017:00; some CAN controllers "
             "and gateways do not pass remote frames";
    case BootAction::await_operational:
      if (failure.emcy == sync_length_emcy && plan.cycle.sync_overflow != 0)
        return against_counter();
      return "the node did not go to OPERATIONAL after NMT start: an error of the device prevents "
             "it (look at its EMCY messages, 0x1001 and 0x1003), or a second master commands "
             "another state";
    default:
      break;
  }
  if (const std::string odd = against_odd_answers(node, failure); !odd.empty()) return odd;
  if (failure.downloading && (failure.moved != 0 || accepted_block(failure))) {
    return "the device stopped answering in the middle of a long value: did it lose power, did it "
           "restart, or does another master use its SDO server? If the device is only slow, raise "
           "`sdo_timeout_ms` of this node. The master did not repeat the write, because the write "
           "might act twice";
  }
  if (failure.downloading) {
    return fmt::format(
        "the device needs longer than {} for {} (flash memory takes seconds): raise "
        "`sdo_timeout_ms` of this node. The master did not repeat the write, because the write "
        "might act twice",
        time_text(step.timeout), to_string(failure.object));
  }
  const std::string silence = remedy_for_silence(plan, node, failure);
  const std::string late = about_earlier_lateness(node, failure);
  return late.empty() || silence.ends_with('?') ? silence + late : silence + "." + late;
}

std::string against_dead_node(const BootStep& step) {
  return fmt::format(
      "the node is kept running when the master starts (`reset: keep_alive`), but shows no sign of "
      "life: at the next try the master reads it by SDO, again without a reset. {}, or use `reset: "
      "communication` if the node may be reset",
      step.guarded ? "Set `guard_time` of this node, if the device can be guarded"
                   : "Let the device keep its heartbeat (0x1017, stored with 0x1010)");
}

/// Returns true if the device has given an answer that shows something about its software.
bool reports_of_program(const BootFailure& failure) noexcept {
  if (failure.letter < 'G' || failure.letter > 'I') return false;
  return failure.fault == SdoFault::none || failure.fault == SdoFault::aborted_by_device ||
         (failure.fault == SdoFault::timeout && failure.letter == 'I');
}

std::string against_program(const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  if (failure.letter == 'G') {
    return "the device does not report its software version in 1F56:01: drop `software_version` "
           "from the network file";
  }
  if (failure.letter == 'H' && failure.running) {
    return fmt::format(
        "the device runs other software than the network file requires, and the node is "
        "OPERATIONAL: stop the machine and reset the node (`takt nmt reset {}`), so that the "
        "master updates it",
        node.id.value());
  }
  if (failure.letter == 'H') {
    return "the device runs other software than the network file requires: name the file with "
           "`software_file`, so that the master loads it, or correct `software_version`";
  }
  if (failure.fault == SdoFault::none && failure.object.index == 0x1F56) {
    return "the program was loaded, but its version differs from `software_version`: correct "
           "`software_file` or `software_version`";
  }
  if (failure.fault == SdoFault::timeout && step.action == BootAction::download_program) {
    return "the device stopped answering in the middle of the program download: it has no program "
           "now, or a part of one. The next try loads the program again; raise `sdo_timeout_ms` if "
           "the flash memory is slow";
  }
  if (failure.fault == SdoFault::timeout) {
    return "the device gives no answer during the program download: does its boot loader support "
           "CANopen, at this node id and bit rate? Switch the device off and on; the next try "
           "loads the program again";
  }
  return "the device did not accept the program: is `software_file` made for this device and its "
         "boot loader? The next try loads the program again";
}

std::string against_running_node(const NodePlan& node, const BootFailure& failure) {
  return fmt::format(
      "the node was OPERATIONAL already, so the master did not configure it, but {} differs from "
      "the network file, and the PDOs can't be used: stop the machine and let the master configure "
      "the node (`takt nmt reset-comm {}`), or correct the network file",
      to_string(failure.object), node.id.value());
}

}  // namespace

std::string remedy(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  if (failure.step >= node.boot_plan.steps.size()) return {};
  const BootStep& step = node.boot_plan.steps[failure.step];
  if (step.action == BootAction::await_alive) return against_dead_node(step);
  if (reports_of_program(failure)) return against_program(node, step, failure);
  if (failure.letter == 'L' && failure.running) return against_running_node(node, failure);
  switch (failure.fault) {
    case SdoFault::none:
      return against_mismatch(node, step, failure);
    case SdoFault::aborted_by_device:
      return against_abort(node, step, failure);
    case SdoFault::aborted_by_master:
      return against_protocol_error(failure);
    case SdoFault::timeout:
      return against_timeout(plan, node, step, failure);
    case SdoFault::too_long:
      return against_long_answer(step, failure);
    case SdoFault::cancelled:
      return "the node restarts again and again during its boot: check the power supply, the "
             "watchdog of the device, and whether another master resets the node";
    default:  // no step of a boot ends in this way
      return {};
  }
}

}  // namespace takt
