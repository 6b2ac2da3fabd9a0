#include <string>

#include "master/core/request.hpp"
#include "master/explain/boot_remedy_abort.hpp"
#include "master/explain/boot_report.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

/// For a node that gets its node-ID by LSS and has given no sign of life.
std::string against_missing_id(const BusPlan& plan, const NodePlan& node) {
  return "node " + std::to_string(int{node.id.value()}) +
         " has sent nothing. LSS (`lss: true`) assigns this id to a device without node id that "
         "has " +
         identity_text(*node.lss) +
         ": `takt lss find` shows the devices without node id. If the device there has another "
         "address, correct the network file; if no device is there, `takt scan` shows whether the "
         "device has another node id already. If the log says that the device has got this id, a "
         "reset of all nodes (`takt nmt reset-comm all`) or a power cycle may be needed before the "
         "device uses the id. Otherwise: is the device powered and wired, is its bit rate " +
         std::to_string(plan.bitrate / 1000) + " kbit/s, does it know LSS fastscan?";
}

/// If no first answer has come, the SDO channel of the network file may be the cause.
std::string about_channel(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  const SdoChannel used = node.sdo.channel_of(node.id);
  if (failure.letter != 'B' || used == default_sdo_channel(node.id)) return {};
  return " The master used the SDO channel of `sdo_channel` (" + to_string(used.request) + " and " +
         to_string(used.answer) +
         "): the device may lack this SDO server, or have it switched off or on other COB-IDs "
         "(`takt sdo read " +
         std::to_string(int{node.id.value()}) + " 1201:01 --bus " + interface_text(plan) +
         "` uses the default channel). Without `sdo_channel` the boot uses the default channel";
}

/// Returns the newest reset before the failure if the node has answered in this boot before that
/// reset and not since. Returns nullptr otherwise.
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

std::string against_silence(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  const std::string id = std::to_string(int{node.id.value()});
  const BootStep* const reset = reset_of_a_node_that_was_there(node, failure);
  if (failure.node_state == NmtState::unknown && reset != nullptr) {
    const bool whole = reset->command == NmtCommand::reset_node;
    return "the node answered before, but has sent nothing since NMT reset " +
           std::string{whole ? "node" : "communication"} + " (" + reset->purpose +
           "): does it need longer to start (raise `boot_timeout_ms`), or does it have another "
           "node id now (`takt scan`)? Otherwise switch it off and on";
  }
  const std::string channel = about_channel(plan, node, failure);
  if (failure.node_state == NmtState::unknown && node.lss) {
    return against_missing_id(plan, node) + channel;
  }
  if (failure.node_state == NmtState::unknown) {
    return "node " + id +
           " has sent nothing: is it powered and wired (CAN_H, CAN_L, ground, 120 ohm at both ends "
           "of the line)? Is its node id " +
           id + " and its bit rate " + std::to_string(plan.bitrate / 1000) +
           " kbit/s? `takt dump --bus " + interface_text(plan) +
           "` shows which nodes send on the bus" + (channel.empty() ? "" : ".") + channel;
  }
  if (failure.node_state == NmtState::stopped) {
    return "the node is in NMT state STOPPED and answers no SDO in this state: let the boot reset "
           "the node (`reset: communication`), or find out which other master stops it";
  }
  return "the node is alive on the bus, but its SDO server does not answer" +
         (channel.empty() ? ":" : "." + channel + ". Otherwise:") +
         " does it need longer to start (raise `boot_timeout_ms` of the node)? Is a second node or "
         "a second master using node id " +
         id + "?";
}

std::string identity_key(char letter) {
  if (letter == 'C') return "device_type";
  return letter == 'D' ? "vendor_id" : "product_code";
}

std::string against_identity(const NodePlan& node, const BootFailure& failure) {
  const std::string id = std::to_string(int{node.id.value()});
  switch (failure.letter) {
    case 'N':
      return "the device has another firmware or hardware revision than " + node.description_file +
             ": use the EDS of this revision, or drop `revision_number` from the network file if "
             "the difference does not matter";
    case 'O':
      return "a device of the same type with another serial number is connected: enter this serial "
             "number in the network file, or drop `serial_number` there";
    default:
      return "a device other than the configured one answers at node id " + id +
             ": check the node ids and the wiring, name the EDS of the connected device instead "
             "of " +
             node.description_file + ", or correct `" + identity_key(failure.letter) +
             "` where the network file gives it";
  }
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

/// The device has accepted a block download and then became silent. CiA 301, 7.2.4.3.9.
bool accepted_block(const BootFailure& failure) noexcept {
  return failure.received_size != 0 && (failure.received[0] & 0xE3) == 0xA0;
}

constexpr std::uint16_t sync_length_emcy = 0x8240;

/// A SYNC came before 0x1019 was written, and some stacks keep that error until their next reset.
std::string against_counter() {
  return "a SYNC with counter reached the device before 0x1019 was written (EMCY 0x8240), and this "
         "error keeps the device out of OPERATIONAL; the next try may succeed. Let the device "
         "store 0x1019 (`store_configuration: 1` of this node), or switch the counter off "
         "(`sync_overflow: 0`)";
}

/// For an endless sequence of segments, or a value that is longer than any object that a boot
/// reads.
std::string against_long_answer(const BootStep& step, const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  if (!step.value.empty() && step.value.size() < request_bytes) {
    return "the device sends more than " + std::to_string(request_bytes) + " bytes for " + object +
           ", which has " + std::to_string(step.value.size()) +
           ": its SDO server is faulty. Look for other firmware, or leave the object out of the "
           "network file";
  }
  return object + " is longer than " + std::to_string(request_bytes) +
         " bytes: remove it from the network file";
}

/// For an answer with fewer bytes than its command specifier needs. CiA 301, 7.2.4.3.1 demands
/// eight bytes.
std::string against_short_answer(const BootFailure& failure) {
  Frame frame;
  frame.length = failure.received_size;
  frame.data = failure.received;
  const std::string faulty =
      ": its SDO server is faulty. Look for other firmware, or for whatever cuts the frames on "
      "their way";
  if (frame.length == 0 && failure.empty_answer) {
    return "the device answers with an empty frame instead of 8 bytes" + faulty;
  }
  if (frame.length == 0 || frame.length >= sdo_answer_bytes(frame)) return {};
  return "the device answers with " + std::to_string(int{frame.length}) +
         " bytes instead of 8, so that a part of the answer is missing" + faulty;
}

/// The device has answered a request after its time-out.
bool was_late(const NodePlan& node, const BootFailure& failure) noexcept {
  return failure.late > node.sdo_timeout && node.sdo_timeout > Time{};
}

/// Lateness explains the failure. If the device has sent nothing for longer than its answers were
/// ever late, the device is silent now, and its late answers were an earlier matter.
bool is_late(const NodePlan& node, const BootFailure& failure) noexcept {
  return was_late(node, failure) && failure.quiet <= failure.late;
}

/// The sentence about late answers that came before the device became silent.
std::string about_earlier_lateness(const NodePlan& node, const BootFailure& failure) {
  if (!was_late(node, failure)) return {};
  return " Before that, the device has answered a request after " + time_text(failure.late) +
         ": raise `sdo_timeout_ms` of this node, too, which is " + time_text(node.sdo_timeout) +
         " now";
}

/// For a server that answers late, with too few bytes, or with another object than the requested
/// one.
std::string against_odd_answers(const NodePlan& node, const BootFailure& failure) {
  if (is_late(node, failure)) {
    return "the device answers after " + time_text(failure.late) + ": raise `sdo_timeout_ms` of " +
           "this node, which is " + time_text(node.sdo_timeout) + " now";
  }
  if (const std::string cut = against_short_answer(failure); !cut.empty()) return cut;
  if (!failure.answered) return {};
  return "the device answers with " + to_string(*failure.answered) + " where " +
         to_string(failure.object) +
         " was requested: its SDO server is faulty (look for other firmware), or a second SDO "
         "client uses this server at the same time (stop other masters and tools)";
}

/// For an answer that breaks the protocol, so that the master has ended the transfer.
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
    return "the device needs longer than " + time_text(step.timeout) + " for " +
           to_string(failure.object) +
           " (flash memory takes seconds): raise `sdo_timeout_ms` of this node. The master did not "
           "repeat the write, because the write might act twice";
  }
  const std::string silence = against_silence(plan, node, failure);
  const std::string late = about_earlier_lateness(node, failure);
  return late.empty() || silence.ends_with('?') ? silence + late : silence + "." + late;
}

std::string against_dead_node(const BootStep& step) {
  return std::string{
             "the node is kept running when the master starts (`reset: keep_alive`), but shows no "
             "sign of life: at the next try the master reads it by SDO, again without a reset. "} +
         (step.guarded ? "Set `guard_time` of this node, if the device can be guarded"
                       : "Let the device keep its heartbeat (0x1017, stored with 0x1010)") +
         ", or use `reset: communication` if the node may be reset";
}

/// The device has given an answer that tells something about its software.
bool reports_of_program(const BootFailure& failure) noexcept {
  if (failure.letter < 'G' || failure.letter > 'I') return false;
  return failure.fault == SdoFault::none || failure.fault == SdoFault::aborted_by_device ||
         (failure.fault == SdoFault::timeout && failure.letter == 'I');
}

std::string against_program(const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  switch (failure.letter) {
    case 'G':
      return "the device does not report its software version in 1F56:01: drop `software_version` "
             "from the network file";
    case 'H':
      return failure.running
                 ? "the device runs other software than the network file requires, and the node is "
                   "OPERATIONAL: stop the machine and reset the node (`takt nmt reset " +
                       std::to_string(int{node.id.value()}) + "`), so that the master updates it"
                 : "the device runs other software than the network file requires: name the file "
                   "with `software_file`, so that the master loads it, or correct "
                   "`software_version`";
    default:
      break;
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
  return "the node was OPERATIONAL already, so the master did not configure it, but " +
         to_string(failure.object) +
         " differs from the network file, and the PDOs can't be used: stop the machine and let the "
         "master configure the node (`takt nmt reset-comm " +
         std::to_string(int{node.id.value()}) + "`), or correct the network file";
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
    case SdoFault::no_such_node:
    case SdoFault::refused:
    case SdoFault::no_such_pdo:
    case SdoFault::not_exchanging:
    case SdoFault::lss_failed:
    case SdoFault::axes_not_stopped:
    case SdoFault::lss_refused:
    case SdoFault::wrong_length:
      break;
  }
  return {};
}

}  // namespace takt
