#include "master/gateway/ascii/ascii_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt::ascii {
namespace {

AsciiError error_of(const LssResult& result) noexcept {
  if (result.outcome != LssOutcome::refused) return AsciiError::timeout;
  if (result.error == 255) return AsciiError::lss_manufacturer;
  if (result.op == LssOp::configure_node_id) return AsciiError::lss_node_id;
  if (result.op == LssOp::configure_bit_timing) return AsciiError::lss_bit_rate;
  return result.error == 2 ? AsciiError::lss_media : AsciiError::lss_store;
}

std::string_view state_text(NmtState state) {
  switch (state) {
    case NmtState::stopped:
      return "STOP";
    case NmtState::operational:
      return "OPER";
    case NmtState::preoperational:
      return "PREO";
    default:
      return {};
  }
}

std::string error_event(AsciiError error) {
  return fmt::format("ERROR {} ({})", std::to_underlying(error), text(error));
}

/// Formats `EMCY code register vendor bytes` as in CiA 309-3.
std::string emcy_event(const Event& event) {
  const std::span bytes{event.bytes};
  return fmt::format("EMCY {:04X} {:02X} {}", load_le<std::uint16_t>(bytes), bytes[2],
                     fmt::join(bytes.subspan(3), " "));
}

/// Returns the first number of each result, in hex.
std::string first_numbers(std::span<const LssResult> results) {
  std::string text;
  for (const LssResult& result : results) {
    text += fmt::format("{}0x{:08X}", text.empty() ? "" : " ", result.numbers[0]);
  }
  return text;
}

}  // namespace

std::string error_line(std::uint32_t sequence, AsciiError error, std::string_view why) {
  return fmt::format("[{}] ERROR: {} ({})", sequence, std::to_underlying(error), why);
}

std::string abort_line(std::uint32_t sequence, std::uint32_t code) {
  return fmt::format("[{}] ERROR: 0x{:08X} ({})", sequence, code, abort_text(code));
}

std::vector<LssResult> lss_results(const Reply& reply) {
  std::vector<LssResult> results;
  const auto bytes = std::span{reply.data}.first(std::min<std::size_t>(reply.size, request_bytes));
  for (std::size_t at = 0; at + lss_result_bytes <= bytes.size(); at += lss_result_bytes) {
    results.push_back(unpack_lss_result(bytes.subspan(at).first<lss_result_bytes>()));
  }
  return results;
}

AsciiError error_of(const Reply& reply) {
  switch (reply.fault) {
    case SdoFault::no_such_node:
    case SdoFault::no_such_pdo:
      return AsciiError::unsupported_node;
    case SdoFault::cancelled:
    case SdoFault::refused:
    case SdoFault::not_exchanging:
    case SdoFault::axes_not_stopped:
      return AsciiError::internal_state;
    case SdoFault::lss_refused:
    case SdoFault::wrong_length:
      return AsciiError::not_supported;
    case SdoFault::lss_failed: {
      const auto results = lss_results(reply);
      return results.empty() ? AsciiError::timeout : error_of(results.back());
    }
    default:
      return AsciiError::timeout;
  }
}

std::string address_text(const LssResult& result) {
  return fmt::format("0x{:08X}", fmt::join(result.numbers, " 0x"));
}

std::string lss_answer(const AsciiCommand& command, const Reply& reply) {
  const auto results = lss_results(reply);
  if (results.empty()) return "OK";
  switch (command.lss.op) {
    case LssOp::fast_scan:
    case LssOp::slow_scan:
      return address_text(results.front());
    case LssOp::inquire_node_id:
      return std::to_string(results.front().numbers[0]);
    case LssOp::inquire_vendor:
    case LssOp::inquire_product:
    case LssOp::inquire_revision:
    case LssOp::inquire_serial:
      return first_numbers(results);
    default:
      return "OK";
  }
}

std::string node_event(const Event& event) {
  switch (event.kind) {
    case EventKind::emcy:
      return emcy_event(event);
    case EventKind::heartbeat_lost:
      return error_event(AsciiError::heartbeat_lost);
    case EventKind::heartbeat_back:
      return error_event(AsciiError::heartbeat_started);
    case EventKind::guarding_lost:
      return error_event(AsciiError::guarding_lost);
    case EventKind::boot_done:
      return "USER BOOT OK";
    case EventKind::boot_failed:
      return std::string{"USER BOOT "} + event.failure.letter;
    case EventKind::node_state: {
      const auto state = static_cast<NmtState>(static_cast<std::uint8_t>(event.value));
      const std::string_view name = state_text(state);
      return name.empty() ? "" : fmt::format("USER STATE {}", name);
    }
    default:
      return {};
  }
}

std::string bus_event(EventKind kind) {
  switch (kind) {
    case EventKind::bus_error_passive:
      return error_event(AsciiError::error_passive);
    case EventKind::bus_off:
      return error_event(AsciiError::bus_off);
    case EventKind::send_buffer_full:
      return error_event(AsciiError::buffer_overflow);
    default:
      return {};
  }
}

bool is_bootup(const Event& event) noexcept {
  const bool message = event.kind == EventKind::node_state &&
                       event.value == static_cast<std::int64_t>(NmtState::bootup);
  return message || event.kind == EventKind::bootup_again;
}

}  // namespace takt::ascii
