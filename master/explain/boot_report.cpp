#include "master/explain/boot_report.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "master/explain/emcy_text.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

/// Adds one line of the explanation: "  sent      605  40 ...".
void add_line(std::string& text, std::string_view label, const std::string& content) {
  if (content.empty()) return;
  text += "\n  ";
  text += label;
  text.append(label.size() < 10 ? 10 - label.size() : 1, ' ');
  text += content;
}

/// A value as "0x0000015A (346)", or its bytes if there are more than eight.
std::string value_text(std::span<const std::uint8_t> bytes, std::size_t size) {
  if (size == 0) return "nothing (zero bytes)";
  if (size > 8) {
    std::string text = std::to_string(size) + " bytes:";
    for (const std::uint8_t byte : bytes) text += " " + hex(byte, 2).substr(2);
    return text + (size > bytes.size() ? " ..." : "");
  }
  const auto value = load_le<std::uint64_t>(bytes.first(std::min(size, bytes.size())));
  std::string digits;
  for (std::size_t i = size; i-- > 0;) digits += hex(bytes[i], 2).substr(2);
  return "0x" + digits + " (" + std::to_string(value) + ")";
}

std::string wanted_text(const BootStep& step) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(step.value.size());
  for (const std::byte byte : step.value) bytes.push_back(static_cast<std::uint8_t>(byte));
  std::string text = value_text(bytes, bytes.size());
  if (step.mask != 0xFFFF'FFFF && bytes.size() <= 4) text += " under the mask " + hex(step.mask, 8);
  return text;
}

std::string sent_text(const NodePlan& node, const BootFailure& failure) {
  if (failure.sent_size == 0) return {};
  const auto bytes = std::span{failure.sent}.first(std::min<std::size_t>(failure.sent_size, 8));
  return frame_text(node.sdo.channel_of(node.id).request, bytes) + "   " +
         (failure.downloading ? "write " : "read ") + to_string(failure.object);
}

std::string silence_text(const BootStep& step, const BootFailure& failure) {
  std::string text = "nothing within " + time_text(step.timeout);
  const bool polls = step.action == BootAction::probe || step.action == BootAction::await_value;
  if (!polls && !failure.downloading && failure.attempts > 1) {
    text += "; the master sent " + std::to_string(int{failure.attempts}) + " requests";
  }
  if (failure.downloading) text += "; the master does not repeat a write";
  return text;
}

std::string received_text(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const bool guarded = step.action == BootAction::await_guarding || step.guarded;
  if (step.action == BootAction::await_alive && !guarded) {
    return "no heartbeat on " + to_string(CobId::base(0x700U + node.id.value())) + " within " +
           time_text(step.timeout);
  }
  switch (step.action) {
    case BootAction::await_heartbeat:
      return "no heartbeat on " + to_string(CobId::base(0x700U + node.id.value())) + " within " +
             time_text(step.timeout);
    case BootAction::await_alive:
    case BootAction::await_guarding:
      return "no answer to guarding requests on " +
             to_string(CobId::base(0x700U + node.id.value())) + " within " +
             time_text(step.timeout);
    case BootAction::await_operational:
      return "heartbeats with the state " + std::string{name(failure.node_state)} + " for " +
             time_text(step.timeout);
    default:
      break;
  }
  if (failure.fault == SdoFault::cancelled) {
    return std::to_string(int{failure.restarts}) +
           " boot-up messages while the node was being booted";
  }
  if (failure.received_size == 0 && !failure.empty_answer) return silence_text(step, failure);
  const auto bytes =
      std::span{failure.received}.first(std::min<std::size_t>(failure.received_size, 8));
  std::string text = frame_text(node.sdo.channel_of(node.id).answer, bytes);
  if (bytes.empty()) text += " an empty frame";
  return failure.fault == SdoFault::timeout ? text + ", then " + silence_text(step, failure) : text;
}

/// Describes the flash status 0x1F57: bit 0 and the error code in bits 7..1. CiA 302-3.
std::string_view flash_text(std::uint8_t status) noexcept {
  if ((status & 1U) != 0) return "the device is still busy with its flash memory";
  switch (status >> 1U) {
    case 0:
      return "the program is good";
    case 1:
      return "there is no valid program";
    case 2:
      return "the format of the program is unknown";
    case 3:
      return "the program has a CRC error";
    case 4:
      return "the flash memory was not erased before the download";
    case 5:
      return "the flash memory could not be written";
    case 6:
      return "the program has a wrong address";
    case 7:
      return "the flash memory is write-protected";
    default:
      return "the device reports a manufacturer-specific flash error";
  }
}

std::string read_value_text(const BootFailure& failure) {
  if (failure.sent_size == 0) return {};
  const std::span bytes =
      std::span{failure.value}.first(std::min<std::size_t>(failure.value_size, 8));
  std::string text = value_text(bytes, failure.value_size);
  if (failure.object.index != 0x1F57 || bytes.empty()) return text;
  return text.append(": ").append(flash_text(bytes[0]));
}

std::string meaning_text(const BootFailure& failure) {
  switch (failure.fault) {
    case SdoFault::none:
      return read_value_text(failure);
    case SdoFault::aborted_by_device:
      return "abort " + abort_digits(failure.abort_code) + ": " +
             std::string{abort_text(failure.abort_code)};
    case SdoFault::aborted_by_master:
    case SdoFault::too_long:
      return "the master aborted with " + abort_digits(failure.abort_code) + ": " +
             std::string{abort_text(failure.abort_code)};
    case SdoFault::timeout:
    case SdoFault::cancelled:
    case SdoFault::no_such_node:
    case SdoFault::refused:
    case SdoFault::no_such_pdo:
    case SdoFault::not_exchanging:
    case SdoFault::lss_failed:
    case SdoFault::axes_not_stopped:
    case SdoFault::lss_refused:
    case SdoFault::wrong_length:
      return {};
  }
  return {};
}

/// Describes the progress of a transfer of more than one frame.
std::string moved_text(const BootStep& step, const BootFailure& failure) {
  const std::string moved = std::to_string(failure.moved);
  if (failure.fault == SdoFault::none) return {};
  if (failure.downloading && step.value.size() > 4) {
    return moved + " of " + std::to_string(step.value.size()) + " bytes";
  }
  return failure.moved > 0 && !failure.downloading ? moved + " bytes" : std::string{};
}

std::string step_title(const BootStep& step) {
  if (!step.purpose.empty()) return step.purpose;
  return step.object == ObjectKey{} ? "unnamed step" : "object " + to_string(step.object);
}

/// The identity entry that an error status is about; empty for any other status.
std::string_view identity_part(char letter) noexcept {
  switch (letter) {
    case 'C':
      return "device type";
    case 'D':
      return "vendor id";
    case 'M':
      return "product code";
    case 'N':
      return "revision number";
    case 'O':
      return "serial number";
    default:
      return {};
  }
}

/// Describes the error status. CiA 302-2 uses the same letter for an identity that differs and for
/// one that the device does not report.
std::string status_text(const BootFailure& failure) {
  const std::string start = std::string{failure.letter} + " of CiA 302-2: ";
  const std::string part{identity_part(failure.letter)};
  if (part.empty() || failure.fault == SdoFault::none) {
    return start + std::string{letter_text(failure.letter)};
  }
  if (failure.fault == SdoFault::timeout) return start + "no answer to the read of the " + part;
  return start + part + " can't be read";
}

std::string heard_text(const BootFailure& failure) {
  if (failure.node_state == NmtState::unknown) return "no boot-up message and no heartbeat";
  const bool only_bootup = failure.node_state == NmtState::bootup;
  std::string text = failure.bootup_seen ? "its boot-up message" : "";
  if (only_bootup) return text;
  return text + (text.empty() ? "" : ", then ") + "heartbeats with the state " +
         std::string{name(failure.node_state)};
}

}  // namespace

std::string_view letter_text(char letter) noexcept {
  static constexpr std::array<std::string_view, 15> texts{
      "the node is not in the network list",
      "no answer to the read of 0x1000",
      "device type differs",
      "vendor id differs",
      "no heartbeat from a node that should be alive",
      "no guarding answer from a node that should be alive",
      "software version can't be checked",
      "software update needed but not allowed",
      "software update failed",
      "configuration failed",
      "no heartbeat or guarding answer at the start of error control",
      "the node was operational already",
      "product code differs",
      "revision number differs",
      "serial number differs",
  };
  if (letter < 'A' || letter > 'O') return "unknown status";
  return texts[static_cast<std::size_t>(letter - 'A')];
}

std::string explain(const BusPlan& plan, std::size_t node_index, const BootFailure& failure) {
  if (node_index >= plan.nodes.size()) return "boot failed on a node that is not in the plan";
  const NodePlan& node = plan.nodes[node_index];
  const auto& steps = node.boot_plan.steps;
  if (failure.step >= steps.size()) return node_text(node) + " failed to boot";
  const BootStep& step = steps[failure.step];

  std::string text = node_text(node) + " failed to boot at step " +
                     std::to_string(failure.step + 1) + " of " + std::to_string(steps.size()) +
                     " (" + step_title(step) + ") after " + time_text(failure.elapsed);
  add_line(text, "sent", sent_text(node, failure));
  add_line(text, "received", received_text(node, step, failure));
  add_line(text, "meaning", meaning_text(failure));
  add_line(text, "moved", moved_text(step, failure));
  if (failure.fault == SdoFault::none && failure.sent_size != 0) {
    add_line(text, "expected", wanted_text(step));
  }
  if (step.action != BootAction::await_operational) {  // CiA 302 has no letter for this failure
    add_line(text, "status", status_text(failure));
  }
  add_line(text, "heard", heard_text(failure));
  if (failure.emcy != 0) {
    add_line(text, "EMCY", hex(failure.emcy) + ": " + std::string{emcy_text(failure.emcy)});
  }
  add_line(text, "EDS", step.eds_note);
  add_line(text, "try", remedy(plan, node, failure));
  return text;
}

}  // namespace takt
