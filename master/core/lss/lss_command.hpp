#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "eds_parser/table/lss_plan.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The services of an LSS master. The values are the command specifiers of the wire where these
/// exist. CiA 305.
enum class LssOp : std::uint8_t {
  switch_global = 0x04,         ///< a: 0 = waiting state, 1 = configuration state
  configure_node_id = 0x11,     ///< a: node-ID 1..127, 255 = no node-ID
  configure_bit_timing = 0x13,  ///< a: bit timing table, b: its entry
  activate_bit_timing = 0x15,   ///< numbers[0]: switch delay, ms
  store = 0x17,
  switch_selective = 0x40,  ///< numbers[0..3]: LSS address
  /// numbers[0..5]: vendor-ID, product code, lowest and highest revision number, lowest and highest
  /// serial number
  identify = 0x46,
  identify_unconfigured = 0x4C,
  /// numbers[0..3]: known bits of the LSS address, [4..7]: mask of the known bits
  fast_scan = 0x51,
  inquire_vendor = 0x5A,  ///< the answer is in numbers[0]
  inquire_product = 0x5B,
  inquire_revision = 0x5C,
  inquire_serial = 0x5D,
  inquire_node_id = 0x5E,
  slow_scan = 0x80,  ///< numbers[0..5]: as for identify; finds the lowest address in these ranges
};

/// One LSS service with its parameters; LssOp says which of them it uses.
struct LssCommand {
  LssOp op = LssOp::switch_global;
  /// First parameter of the service, as LssOp describes it.
  std::uint8_t a = 0;
  /// Second parameter of the service, as LssOp describes it.
  std::uint8_t b = 0;
  bool several = false;  ///< configure and store: wait for the answers of several devices; the
                         ///< worst answer counts
  std::array<std::uint32_t, 8> numbers{};
};
static_assert(std::is_trivially_copyable_v<LssCommand>);

/// The way in which an LSS service has ended.
enum class LssOutcome : std::uint8_t {
  done,
  silent,   ///< No device has answered.
  nobody,   ///< identify and the scans: no device matches the question
  refused,  ///< The device has answered with `error`.
  lost,     ///< Devices became silent in the middle of a scan, or gave contradictory answers.
};

/// Result of an LSS service.
struct LssResult {
  LssOp op = LssOp::switch_global;
  LssOutcome outcome = LssOutcome::done;
  std::uint8_t error = 0;
  std::uint8_t specific = 0;
  /// Answer of inquire, or the LSS address that a scan has found.
  std::array<std::uint32_t, 4> numbers{};
  std::uint32_t frames = 0;  ///< number of frames that were sent
};
static_assert(std::is_trivially_copyable_v<LssResult>);

/// Returns the time for which the master waits for an answer unless the caller gives a time.
Time default_timeout(LssOp op) noexcept;

// Sizes of the packed forms that requests and replies carry, little endian. A command consists of
// op, a, b, several and 8 numbers; a result of op, outcome, error, specific, 4 numbers and frames.
inline constexpr std::size_t lss_command_bytes = 36;
inline constexpr std::size_t lss_result_bytes = 24;
void pack(const LssCommand& command, std::span<std::byte, lss_command_bytes> bytes) noexcept;
void pack(const LssResult& result, std::span<std::byte, lss_result_bytes> bytes) noexcept;
/// Returns std::nullopt if there is no such service, or if a parameter is out of range.
std::optional<LssCommand> unpack_lss_command(
    std::span<const std::byte, lss_command_bytes> bytes) noexcept;
LssResult unpack_lss_result(std::span<const std::byte, lss_result_bytes> bytes) noexcept;

/// Describes a failure: "store configuration: the device does not support it (error 1)". Returns an
/// empty text if the service was done.
std::string lss_failure_text(const LssResult& result);

}  // namespace takt
