#include "master/explain/boot_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "master/explain/boot_remedy.hpp"
#include "master/explain/emcy_text.hpp"
#include "master/explain/report_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

/// Adds one line to the explanation, such as " sent 605 40 ...".
void add_line(std::string& text, std::string_view label, std::string_view content) {
  if (!content.empty()) text += fmt::format("\n  {:<9} {}", label, content);
}

/// Returns a value as "0x0000015A (346)", or its bytes if there are more than eight.
std::string value_text(std::span<const std::uint8_t> bytes, std::size_t size) {
  if (size == 0) return "nothing (zero bytes)";
  if (size > 8) {
    return fmt::format("{} bytes: {}{}", size, bytes_text(bytes),
                       size > bytes.size() ? " ..." : "");
  }
  const auto value = load_le<std::uint64_t>(bytes.first(std::min(size, bytes.size())));
  return fmt::format("0x{:0{}X} ({})", value, 2 * size, value);
}

std::string wanted_text(const BootStep& step) {
  const std::size_t size = step.value.size();
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(step.value.data());
  const std::string text = value_text({bytes, size}, size);
  const bool masked = step.mask != 0xFFFF'FFFF && size <= 4;
  return masked ? fmt::format("{} under the mask 0x{:08X}", text, step.mask) : text;
}

std::string sent_text(const NodePlan& node, const BootFailure& failure) {
  if (failure.sent_size == 0) return {};
  const auto bytes = std::span{failure.sent}.first(std::min<std::size_t>(failure.sent_size, 8));
  return fmt::format("{}   {} {}", frame_text(node.sdo.channel_of(node.id).request, bytes),
                     failure.downloading ? "write" : "read", to_string(failure.object));
}

std::string silence_text(const BootStep& step, const BootFailure& failure) {
  std::string text = "nothing within " + time_text(step.timeout);
  const bool polls = step.action == BootAction::probe || step.action == BootAction::await_value;
  if (!polls && !failure.downloading && failure.attempts > 1) {
    text += fmt::format("; the master sent {} requests", failure.attempts);
  }
  if (failure.downloading) text += "; the master does not repeat a write";
  return text;
}

std::string received_text(const NodePlan& node, const BootStep& step, const BootFailure& failure) {
  const std::string within = fmt::format(
      "on {} within {}", to_string(CobId::base(0x700U + node.id.value())), time_text(step.timeout));
  switch (step.action) {
    case BootAction::await_heartbeat:
      return "no heartbeat " + within;
    case BootAction::await_alive:
      return (step.guarded ? "no answer to guarding requests " : "no heartbeat ") + within;
    case BootAction::await_guarding:
      return "no answer to guarding requests " + within;
    case BootAction::await_operational:
      return fmt::format("heartbeats with the state {} for {}", name(failure.node_state),
                         time_text(step.timeout));
    default:
      break;
  }
  if (failure.fault == SdoFault::cancelled) {
    return fmt::format("{} boot-up messages while the node was being booted", failure.restarts);
  }
  if (failure.received_size == 0 && !failure.empty_answer) return silence_text(step, failure);
  const auto bytes =
      std::span{failure.received}.first(std::min<std::size_t>(failure.received_size, 8));
  std::string text = frame_text(node.sdo.channel_of(node.id).answer, bytes);
  if (bytes.empty()) text += "an empty frame";
  return failure.fault == SdoFault::timeout ? text + ", then " + silence_text(step, failure) : text;
}

/// Describes the flash status 0x1F57: bit 0 and the error code in bits 7..1. CiA 302-3.
std::string_view flash_text(std::uint8_t status) noexcept {
  constexpr std::string_view errors[] = {"the program is good",
                                         "there is no valid program",
                                         "the format of the program is unknown",
                                         "the program has a CRC error",
                                         "the flash memory was not erased before the download",
                                         "the flash memory could not be written",
                                         "the program has a wrong address",
                                         "the flash memory is write-protected"};
  if ((status & 1U) != 0) return "the device is still busy with its flash memory";
  const std::size_t error = status >> 1U;
  return error < std::size(errors) ? errors[error]
                                   : "the device reports a manufacturer-specific flash error";
}

std::string read_value_text(const BootFailure& failure) {
  if (failure.sent_size == 0) return {};
  const std::span bytes =
      std::span{failure.value}.first(std::min<std::size_t>(failure.value_size, 8));
  std::string text = value_text(bytes, failure.value_size);
  if (failure.object.index != 0x1F57 || bytes.empty()) return text;
  return fmt::format("{}: {}", text, flash_text(bytes[0]));
}

std::string meaning_text(const BootFailure& failure) {
  const auto abort = [&] {
    return fmt::format("{}: {}", abort_digits(failure.abort_code), abort_text(failure.abort_code));
  };
  switch (failure.fault) {
    case SdoFault::none:
      return read_value_text(failure);
    case SdoFault::aborted_by_device:
      return "abort " + abort();
    case SdoFault::aborted_by_master:
    case SdoFault::too_long:
      return "the master aborted with " + abort();
    default:
      return {};
  }
}

/// Describes the progress of a transfer of more than one frame.
std::string moved_text(const BootStep& step, const BootFailure& failure) {
  if (failure.fault == SdoFault::none) return {};
  if (failure.downloading && step.value.size() > 4) {
    return fmt::format("{} of {} bytes", failure.moved, step.value.size());
  }
  if (failure.downloading || failure.moved == 0) return {};
  return fmt::format("{} bytes", failure.moved);
}

std::string step_title(const BootStep& step) {
  if (!step.purpose.empty()) return step.purpose;
  return step.object == ObjectKey{} ? "unnamed step" : "object " + to_string(step.object);
}

/// Describes the error status. CiA 302-2 uses the same letter for an identity that differs and for
/// one that the device does not report.
std::string status_text(const BootFailure& failure) {
  const auto status = [&](std::string_view text) {
    return fmt::format("{} of CiA 302-2: {}", failure.letter, text);
  };
  constexpr std::string_view differs = " differs";
  std::string_view identity = letter_text(failure.letter);
  if (failure.fault == SdoFault::none || !identity.ends_with(differs)) return status(identity);
  identity.remove_suffix(differs.size());
  return status(failure.fault == SdoFault::timeout
                    ? fmt::format("no answer to the read of the {}", identity)
                    : fmt::format("{} can't be read", identity));
}

std::string heard_text(const BootFailure& failure) {
  if (failure.node_state == NmtState::unknown) return "no boot-up message and no heartbeat";
  const std::string bootup = failure.bootup_seen ? "its boot-up message" : "";
  if (failure.node_state == NmtState::bootup) return bootup;
  return fmt::format("{}{}heartbeats with the state {}", bootup, bootup.empty() ? "" : ", then ",
                     name(failure.node_state));
}

}  // namespace

std::string_view letter_text(char letter) noexcept {
  static constexpr std::string_view texts[] = {
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
  const auto index = static_cast<std::size_t>(letter - 'A');
  return index < std::size(texts) ? texts[index] : "unknown status";
}

std::string explain(const BusPlan& plan, std::size_t node_index, const BootFailure& failure) {
  if (node_index >= plan.nodes.size()) return "boot failed on a node that is not in the plan";
  const NodePlan& node = plan.nodes[node_index];
  const auto& steps = node.boot_plan.steps;
  if (failure.step >= steps.size()) return node_text(node) + " failed to boot";
  const BootStep& step = steps[failure.step];

  std::string text =
      fmt::format("{} failed to boot at step {} of {} ({}) after {}", node_text(node),
                  failure.step + 1, steps.size(), step_title(step), time_text(failure.elapsed));
  add_line(text, "sent", sent_text(node, failure));
  add_line(text, "received", received_text(node, step, failure));
  add_line(text, "meaning", meaning_text(failure));
  add_line(text, "moved", moved_text(step, failure));
  if (failure.fault == SdoFault::none && failure.sent_size != 0) {
    add_line(text, "expected", wanted_text(step));
  }
  if (step.action != BootAction::await_operational) {  // CiA 302 has no letter for this failure.
    add_line(text, "status", status_text(failure));
  }
  add_line(text, "heard", heard_text(failure));
  if (failure.emcy != 0) {
    add_line(text, "EMCY", fmt::format("{}: {}", hex(failure.emcy), emcy_text(failure.emcy)));
  }
  add_line(text, "EDS", step.eds_note);
  add_line(text, "try", remedy(plan, node, failure));
  return text;
}

}  // namespace takt
