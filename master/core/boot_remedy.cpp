#include <string>

#include "master/core/boot_remedy_abort.hpp"
#include "master/core/boot_report.hpp"
#include "master/core/report_text.hpp"
#include "master/core/request.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

/// For a node that gets its node-ID by LSS and has given no sign of life.
std::string against_missing_id(const BusPlan& plan, const NodePlan& node) {
  return "nothing at all was heard of node " + std::to_string(int{node.id.value()}) +
         ", which gets this id by LSS (`lss: true`) as soon as a device without id answers that "
         "has " +
         identity_text(*node.lss) +
         ": `takt lss find` shows who is without id. Where it is another one, correct the network "
         "file; where it is not there, `takt scan` shows whether it has another id already. Where "
         "the log says that it has got this id, it may want a reset of all nodes (`takt nmt "
         "reset-comm all`), or to be switched off and on, before it uses it. "
         "Else: is it powered, and wired, is its bit rate " +
         std::to_string(plan.bitrate / 1000) + " kbit/s, does it know LSS fastscan?";
}

/// If no first answer has come, the SDO channel of the network file may be the cause.
std::string about_channel(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  const SdoChannel used = node.sdo.channel_of(node.id);
  if (failure.letter != 'B' || used == default_sdo_channel(node.id)) return {};
  return " It was asked on the SDO channel that `sdo_channel` names (" + to_string(used.request) +
         " and " + to_string(used.answer) +
         "): the device may not have this server, may have it off or on other COB-IDs "
         "(`takt sdo read " +
         std::to_string(int{node.id.value()}) + " 1201:01 --bus " + interface_text(plan) +
         "` asks on the default channel). Without `sdo_channel` the boot goes over the default "
         "channel";
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
    return "the node was there, and did not come back from NMT reset " +
           std::string{whole ? "node" : "communication"} + " (" + reset->purpose +
           "): does it need longer to start (raise `boot_timeout_ms`), or has it another node id "
           "now (`takt scan`)? Else switch it off and on";
  }
  const std::string channel = about_channel(plan, node, failure);
  if (failure.node_state == NmtState::unknown && node.lss) {
    return against_missing_id(plan, node) + channel;
  }
  if (failure.node_state == NmtState::unknown) {
    return "nothing at all was heard of node " + id +
           ": is it powered, and wired (CAN_H, CAN_L, ground, 120 ohm at both ends of the line)? "
           "Is "
           "its node id " +
           id + " and its bit rate " + std::to_string(plan.bitrate / 1000) +
           " kbit/s? `takt dump --bus " + interface_text(plan) + "` shows who talks on the bus" +
           (channel.empty() ? "" : ".") + channel;
  }
  if (failure.node_state == NmtState::stopped) {
    return "the node is in NMT state STOPPED, where it answers no SDO: let the boot reset it "
           "(`reset: communication`), or stop whoever stops it";
  }
  return "the node is alive on the bus but its SDO server keeps silent" +
         (channel.empty() ? ":" : "." + channel + ". Else:") +
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
             "the "
             "difference doesn't matter";
    case 'O':
      return "another specimen of the device is connected: enter its serial number in the network "
             "file, or drop `serial_number` there";
    default:
      return "another device than the one that was configured answers at node id " + id +
             ": check the node ids and the wiring, name the EDS of the device that is there "
             "instead of " +
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
    return "the device took the write but holds another value (it rounds, limits or ignores it): "
           "enter the value it keeps in the network file";
  }
  return "the device holds another value in " + to_string(failure.object) +
         " than the network file expects: correct whichever is wrong";
}

/// The device has accepted a block download and then became silent. CiA 301, 7.2.4.3.9.
bool accepted_block(const BootFailure& failure) noexcept {
  return failure.received_size != 0 && (failure.received[0] & 0xE3) == 0xA0;
}

constexpr std::uint16_t sync_length_emcy = 0x8240;

/// A SYNC came before 0x1019 was written, and some stacks keep that error until their next reset.
std::string against_counter() {
  return "SYNC came with its counter before the device knew of it (EMCY 0x8240), and this error "
         "keeps it out of OPERATIONAL; it may pass with the next try. Let the device keep 0x1019 "
         "(`store_configuration: 1` of this node), or go without counter (`sync_overflow: 0`)";
}

/// For an endless sequence of segments, or a value that is longer than any object that a boot
/// reads.
std::string against_long_answer(const BootStep& step, const BootFailure& failure) {
  const std::string object = to_string(failure.object);
  if (!step.value.empty() && step.value.size() < request_bytes) {
    return "the device sends more than " + std::to_string(request_bytes) + " bytes for " + object +
           ", which has " + std::to_string(step.value.size()) +
           ": its SDO server is faulty. Look for other firmware, or leave the object out";
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
  if (frame.length == 0 || frame.length >= sdo_answer_bytes(frame)) return {};
  return "the device answers with " + std::to_string(int{frame.length}) +
         " bytes instead of 8, so that a part of the answer is missing: its SDO server is faulty. "
         "Look for other firmware, or for whatever cuts the frames on their way";
}

/// For a server that answers late, with too few bytes, or with another object than the requested
/// one.
std::string against_odd_answers(const NodePlan& node, const BootFailure& failure) {
  if (failure.late > node.sdo_timeout && node.sdo_timeout > Time{}) {
    return "the device answers after " + time_text(failure.late) + ": raise `sdo_timeout_ms` of " +
           "this node, which is " + time_text(node.sdo_timeout) + " now";
  }
  if (const std::string cut = against_short_answer(failure); !cut.empty()) return cut;
  if (!failure.answered) return {};
  return "the device answers with " + to_string(*failure.answered) + " where " +
         to_string(failure.object) +
         " was asked for: its SDO server is faulty (look for other firmware), or a second SDO "
         "client talks to it at the same time (stop other masters and tools)";
}

/// For an answer that breaks the protocol, so that the master has ended the transfer.
std::string against_protocol_error(const BootFailure& failure) {
  const std::string other =
      ". Or a second SDO client talks to the node at the same time (stop other masters and tools)";
  if (failure.abort_code == abort_code::toggle_not_alternated) {
    return "the device does not alternate the toggle bit of its segments, so that one may be lost "
           "or come twice; the master has ended the transfer. Its SDO server is faulty with values "
           "of more than 4 bytes: look for other firmware, or leave the object out" +
           other;
  }
  if (failure.abort_code == abort_code::command_unknown) {
    return "the answer has a command specifier that does not belong to the request; the master has "
           "ended the transfer. The SDO server of the device is faulty: look for other firmware" +
           other;
  }
  return "the answers break the SDO protocol, and the master has ended the transfer: the SDO "
         "server of the device is faulty" +
         other + ", or two nodes share the id";
}

std::string against_timeout(const BusPlan& plan, const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  switch (step.action) {
    case BootAction::await_heartbeat:
      return failure.node_state == NmtState::unknown || failure.node_state == NmtState::bootup
                 ? "the device produces no heartbeat: is 0x1017 not zero after the boot? Set "
                   "`heartbeat_producer` of this node in ms, or 0 to go without"
                 : "the heartbeat is slower than expected: raise `heartbeat_multiplier` or lower "
                   "`heartbeat_producer` of this node";
    case BootAction::await_guarding:
      return "the device does not answer guarding requests (remote frames): set `guard_time: 0` of "
             "this node, or `heartbeat_producer` where the device has 1017:00; some CAN "
             "controllers and gateways do not pass remote frames";
    case BootAction::await_operational:
      if (failure.emcy == sync_length_emcy && plan.cycle.sync_overflow != 0)
        return against_counter();
      return "the node did not obey NMT start: an error keeps it out of OPERATIONAL (look at its "
             "EMCY messages, 0x1001 and 0x1003), or a second master holds it back";
    default:
      break;
  }
  if (const std::string odd = against_odd_answers(node, failure); !odd.empty()) return odd;
  if (failure.downloading && (failure.moved != 0 || accepted_block(failure))) {
    return "the device fell silent in the middle of a long value: did it lose power, restart, or "
           "does another master talk to it? Raise `sdo_timeout_ms` of this node where it only is "
           "slow. The write was not repeated, because it might act twice";
  }
  if (failure.downloading) {
    return "the device needs longer than " + time_text(step.timeout) + " for " +
           to_string(failure.object) +
           " (flash memory takes seconds): raise `sdo_timeout_ms` of this node. The write was not "
           "repeated, because it might act twice";
  }
  return against_silence(plan, node, failure);
}

std::string against_dead_node(const BootStep& step) {
  return std::string{
             "the node is kept running when the master starts (`reset: keep_alive`), but "
             "shows no sign of life: it is asked by SDO with the next try, still without a "
             "reset. "} +
         (step.guarded ? "Set `guard_time` of this node, if the device can be guarded"
                       : "Let the device keep its heartbeat (0x1017, stored with 0x1010)") +
         ", or use `reset: communication` where it may be reset";
}

/// The device has given an answer that tells something about its software.
bool tells_of_program(const BootFailure& failure) noexcept {
  if (failure.letter < 'G' || failure.letter > 'I') return false;
  return failure.fault == SdoFault::none || failure.fault == SdoFault::aborted_by_device ||
         (failure.fault == SdoFault::timeout && failure.letter == 'I');
}

std::string against_program(const NodePlan& node, const BootStep& step,
                            const BootFailure& failure) {
  switch (failure.letter) {
    case 'G':
      return "the device does not tell the version of its software in 1F56:01: drop "
             "`software_version` from the network file";
    case 'H':
      return failure.running
                 ? "the device runs another software than the network file wants, and it is "
                   "OPERATIONAL: stop the machine and reset the node (`takt nmt reset " +
                       std::to_string(int{node.id.value()}) + "`), then it is updated"
                 : "the device runs another software than the network file wants: name the file "
                   "with `software_file` and takt loads it, or correct `software_version`";
    default:
      break;
  }
  if (failure.fault == SdoFault::none && failure.object.index == 0x1F56) {
    return "the program was loaded, but it is another version than `software_version` says: "
           "correct whichever is wrong";
  }
  if (failure.fault == SdoFault::timeout && step.action == BootAction::download_program) {
    return "the device fell silent in the middle of its program: it has none now, or a part of it. "
           "It is loaded anew with the next try; raise `sdo_timeout_ms` where its flash memory is "
           "slow";
  }
  if (failure.fault == SdoFault::timeout) {
    return "the device gives no answer while its program is loaded: does its boot loader talk "
           "CANopen, at this node id and bit rate? Switch it off and on; the program is loaded "
           "anew with the next try";
  }
  return "the device did not take the program: is `software_file` made for this device and its "
         "boot loader? The next try loads it anew";
}

std::string against_running_node(const NodePlan& node, const BootFailure& failure) {
  return "the node was OPERATIONAL already and is not touched, but " + to_string(failure.object) +
         " is not what the network file wants, so its PDOs can't be used: stop the machine, then "
         "`takt nmt reset-comm " +
         std::to_string(int{node.id.value()}) +
         "` lets it be configured; or correct the network file";
}

}  // namespace

std::string remedy(const BusPlan& plan, const NodePlan& node, const BootFailure& failure) {
  if (failure.step >= node.boot_plan.steps.size()) return {};
  const BootStep& step = node.boot_plan.steps[failure.step];
  if (step.action == BootAction::await_alive) return against_dead_node(step);
  if (tells_of_program(failure)) return against_program(node, step, failure);
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
      return "the node restarts again and again while it is booted: weak supply, its watchdog, or "
             "another master that resets it";
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
