#include "master/core/lss/lss_command.hpp"

#include <algorithm>
#include <string_view>

#include "eds_parser/table/waits.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

struct KnownService {
  LssOp op;
  std::string_view name;
  Time timeout = waits::lss_answer;
};

constexpr std::array known_services{
    KnownService{LssOp::switch_global, "switch the state of all devices"},
    KnownService{LssOp::configure_node_id, "configure node id"},
    KnownService{LssOp::configure_bit_timing, "configure bit timing"},
    KnownService{LssOp::activate_bit_timing, "activate bit timing"},
    KnownService{LssOp::store, "store configuration", waits::lss_store},
    KnownService{LssOp::switch_selective, "switch one device to configuration state"},
    KnownService{LssOp::identify, "identify by ranges", waits::lss_all},
    KnownService{LssOp::identify_unconfigured, "look for devices without node id", waits::lss_all},
    KnownService{LssOp::fast_scan, "fastscan", waits::lss_all},
    KnownService{LssOp::inquire_vendor, "inquire vendor id"},
    KnownService{LssOp::inquire_product, "inquire product code"},
    KnownService{LssOp::inquire_revision, "inquire revision"},
    KnownService{LssOp::inquire_serial, "inquire serial number"},
    KnownService{LssOp::inquire_node_id, "inquire node id"},
    KnownService{LssOp::slow_scan, "scan by ranges", waits::lss_all},
};

/// Returns nullptr if there is no such service.
constexpr const KnownService* find_service(LssOp op) noexcept {
  const auto found = std::ranges::find(known_services, op, &KnownService::op);
  return found == known_services.end() ? nullptr : &*found;
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

struct Refusal {
  LssOp op;
  std::uint8_t error;
  const char* text;
};

/// The error codes of CiA 305.
constexpr std::array refusals{
    Refusal{LssOp::configure_node_id, 1, "the device reports that this node id is out of range"},
    Refusal{LssOp::configure_bit_timing, 1, "the device does not support this bit rate"},
    Refusal{LssOp::store, 1, "the device does not support storing"},
    Refusal{LssOp::store, 2, "the device could not access its storage medium"},
};

std::string refusal(const LssResult& result) {
  if (result.error == 255) {
    return "the device gave the manufacturer-specific error code " +
           std::to_string(result.specific);
  }
  const auto found = std::ranges::find_if(refusals, [&](const Refusal& known) {
    return known.op == result.op && known.error == result.error;
  });
  const std::string text = found != refusals.end()
                               ? found->text
                               : "the device gave an error code that CiA 305 does not know";
  return text + " (error " + std::to_string(result.error) + ")";
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
  const KnownService* const service = find_service(op);
  return service == nullptr ? waits::lss_answer : service->timeout;
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
  const auto op = static_cast<LssOp>(bytes[0]);
  if (find_service(op) == nullptr) return {};
  LssCommand command{.op = op,
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
  const auto why = [&result]() -> std::string {
    switch (result.outcome) {
      case LssOutcome::done:
        return {};
      case LssOutcome::silent:
        return "no answer; is there a device in configuration state, with LSS, on this bus?";
      case LssOutcome::nobody:
        return nobody(result.op);
      case LssOutcome::refused:
        return refusal(result);
      case LssOutcome::lost:
        return "the answers of the devices contradict each other; the devices may be slower than "
               "the time-out, or several devices may have the same LSS address";
    }
    return "unknown outcome";
  }();
  if (why.empty()) return {};
  const KnownService* const service = find_service(result.op);
  return std::string{service ? service->name : "unknown service"} + ": " + why;
}

}  // namespace takt
