#include "master/core/lss/lss_command.hpp"

#include <algorithm>

#include "eds_parser/table/waits.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

bool is_service(std::uint8_t op) noexcept {
  switch (static_cast<LssOp>(op)) {
    case LssOp::switch_global:
    case LssOp::configure_node_id:
    case LssOp::configure_bit_timing:
    case LssOp::activate_bit_timing:
    case LssOp::store:
    case LssOp::switch_selective:
    case LssOp::identify:
    case LssOp::identify_unconfigured:
    case LssOp::fast_scan:
    case LssOp::inquire_vendor:
    case LssOp::inquire_product:
    case LssOp::inquire_revision:
    case LssOp::inquire_serial:
    case LssOp::inquire_node_id:
    case LssOp::slow_scan:
      return true;
  }
  return false;
}

bool has_sense(const LssCommand& command) noexcept {
  switch (command.op) {
    case LssOp::switch_global:
      return command.a <= 1;
    case LssOp::activate_bit_timing:
      return command.numbers[0] <= 0xFFFF;
    case LssOp::identify:
    case LssOp::slow_scan:
      return command.numbers[2] <= command.numbers[3] && command.numbers[4] <= command.numbers[5];
    default:
      return true;
  }
}

std::string what(LssOp op) {
  switch (op) {
    case LssOp::switch_global:
      return "switch the state of all devices";
    case LssOp::configure_node_id:
      return "configure node id";
    case LssOp::configure_bit_timing:
      return "configure bit timing";
    case LssOp::activate_bit_timing:
      return "activate bit timing";
    case LssOp::store:
      return "store configuration";
    case LssOp::switch_selective:
      return "switch one device to configuration state";
    case LssOp::identify:
      return "identify by ranges";
    case LssOp::identify_unconfigured:
      return "look for devices without node id";
    case LssOp::fast_scan:
      return "fastscan";
    case LssOp::inquire_vendor:
      return "inquire vendor id";
    case LssOp::inquire_product:
      return "inquire product code";
    case LssOp::inquire_revision:
      return "inquire revision";
    case LssOp::inquire_serial:
      return "inquire serial number";
    case LssOp::inquire_node_id:
      return "inquire node id";
    case LssOp::slow_scan:
      return "scan by ranges";
  }
  return "unknown service";
}

/// Describes the error codes of configure node-ID, configure bit timing and store. CiA 305.
std::string refusal(const LssResult& result) {
  const std::string code = " (error " + std::to_string(result.error) + ")";
  if (result.error == 255) {
    return "the device gave the manufacturer-specific error code " +
           std::to_string(result.specific);
  }
  if (result.op == LssOp::configure_node_id && result.error == 1) {
    return "the device reports that this node id is out of range" + code;
  }
  if (result.op == LssOp::configure_bit_timing && result.error == 1) {
    return "the device does not support this bit rate" + code;
  }
  if (result.op == LssOp::store && result.error == 1) {
    return "the device does not support storing" + code;
  }
  if (result.op == LssOp::store && result.error == 2) {
    return "the device could not access its storage medium" + code;
  }
  return "the device gave an error code that CiA 305 does not know" + code;
}

std::string nobody(LssOp op) {
  if (op == LssOp::identify || op == LssOp::slow_scan) {
    return "no device reports an LSS address in these ranges; not every device supports this "
           "service";
  }
  if (op == LssOp::fast_scan) {
    return "no device without node id has such an LSS address; devices with a node id do not take "
           "part";
  }
  return "no device reports that it has no node id; not every device supports this service; `takt "
         "lss find` uses fastscan";
}

}  // namespace

Time default_timeout(LssOp op) noexcept {
  switch (op) {
    case LssOp::store:
      return waits::lss_store;
    case LssOp::identify:
    case LssOp::identify_unconfigured:
    case LssOp::fast_scan:
    case LssOp::slow_scan:
      return waits::lss_all;
    default:
      return waits::lss_answer;
  }
}

void pack(const LssCommand& command, std::span<std::byte, lss_command_bytes> bytes) noexcept {
  bytes[0] = static_cast<std::byte>(command.op);
  bytes[1] = static_cast<std::byte>(command.a);
  bytes[2] = static_cast<std::byte>(command.b);
  bytes[3] = static_cast<std::byte>(command.several ? 1 : 0);
  for (std::size_t i = 0; i < command.numbers.size(); ++i) {
    store_le(bytes.subspan(4 + 4 * i), command.numbers[i]);
  }
}

void pack(const LssResult& result, std::span<std::byte, lss_result_bytes> bytes) noexcept {
  bytes[0] = static_cast<std::byte>(result.op);
  bytes[1] = static_cast<std::byte>(result.outcome);
  bytes[2] = static_cast<std::byte>(result.error);
  bytes[3] = static_cast<std::byte>(result.specific);
  for (std::size_t i = 0; i < result.numbers.size(); ++i) {
    store_le(bytes.subspan(4 + 4 * i), result.numbers[i]);
  }
  store_le(bytes.subspan(20), result.frames);
}

std::optional<LssCommand> unpack_lss_command(
    std::span<const std::byte, lss_command_bytes> bytes) noexcept {
  const auto op = std::to_integer<std::uint8_t>(bytes[0]);
  if (!is_service(op)) return {};
  LssCommand command{.op = static_cast<LssOp>(op),
                     .a = std::to_integer<std::uint8_t>(bytes[1]),
                     .b = std::to_integer<std::uint8_t>(bytes[2]),
                     .several = bytes[3] != std::byte{0}};
  for (std::size_t i = 0; i < command.numbers.size(); ++i) {
    command.numbers[i] = load_le<std::uint32_t>(bytes.subspan(4 + 4 * i));
  }
  if (!has_sense(command)) return {};
  return command;
}

LssResult unpack_lss_result(std::span<const std::byte, lss_result_bytes> bytes) noexcept {
  LssResult result{.op = static_cast<LssOp>(bytes[0]),
                   .outcome = static_cast<LssOutcome>(bytes[1]),
                   .error = std::to_integer<std::uint8_t>(bytes[2]),
                   .specific = std::to_integer<std::uint8_t>(bytes[3])};
  for (std::size_t i = 0; i < result.numbers.size(); ++i) {
    result.numbers[i] = load_le<std::uint32_t>(bytes.subspan(4 + 4 * i));
  }
  result.frames = load_le<std::uint32_t>(bytes.subspan(20));
  return result;
}

std::string lss_failure_text(const LssResult& result) {
  switch (result.outcome) {
    case LssOutcome::done:
      return {};
    case LssOutcome::silent:
      return what(result.op) +
             ": no answer; is there a device in configuration state, with LSS, on this bus?";
    case LssOutcome::nobody:
      return what(result.op) + ": " + nobody(result.op);
    case LssOutcome::refused:
      return what(result.op) + ": " + refusal(result);
    case LssOutcome::lost:
      return what(result.op) +
             ": the answers of the devices contradict each other; the devices may be slower than "
             "the time-out, or several devices may have the same LSS address";
  }
  return what(result.op) + ": unknown outcome";
}

}  // namespace takt
