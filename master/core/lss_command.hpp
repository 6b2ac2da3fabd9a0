#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "eds_parser/table/lss_plan.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// The services of an LSS master. Numbers are those of the wire where there are some. CiA 305.
enum class LssOp : std::uint8_t {
  switch_global = 0x04,         ///< a: 0 waiting, 1 configuration
  configure_node_id = 0x11,     ///< a: 1..127, 255 = none
  configure_bit_timing = 0x13,  ///< a: table, b: entry
  activate_bit_timing = 0x15,   ///< numbers[0]: switch delay, ms
  store = 0x17,
  switch_selective = 0x40,  ///< numbers[0..3]: LSS address
  /// numbers[0..5]: vendor, product, revision from and to, serial from and to
  identify = 0x46,
  identify_unconfigured = 0x4C,
  fast_scan = 0x51,       ///< numbers[0..3]: LSS address as far as known, [4..7]: which bits are
  inquire_vendor = 0x5A,  ///< the answer is in numbers[0]
  inquire_product = 0x5B,
  inquire_revision = 0x5C,
  inquire_serial = 0x5D,
  inquire_node_id = 0x5E,
  slow_scan = 0x80,  ///< numbers[0..5] as identify: the lowest address in these ranges
};

struct LssCommand {
  LssOp op = LssOp::switch_global;
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  bool several = false;  ///< configure, store: waits for the answers of all; the worst one counts
  std::array<std::uint32_t, 8> numbers{};
};
static_assert(std::is_trivially_copyable_v<LssCommand>);

enum class LssOutcome : std::uint8_t {
  done,
  silent,   ///< no device has answered
  nobody,   ///< nobody is there whom the question concerns: identify and the scans
  refused,  ///< the device gave `error`
  lost,     ///< devices fell silent in the middle of a scan, or answered without sense
};

struct LssResult {
  LssOp op = LssOp::switch_global;
  LssOutcome outcome = LssOutcome::done;
  std::uint8_t error = 0;
  std::uint8_t specific = 0;
  std::array<std::uint32_t, 4> numbers{};  ///< answer of inquire, LSS address of the scans
  std::uint32_t frames = 0;                ///< that were sent
};
static_assert(std::is_trivially_copyable_v<LssResult>);

/// How long an answer may take where the caller does not say.
Time default_timeout(LssOp op) noexcept;

// As requests and replies carry them, little endian: op, a, b, several, 8 numbers; and op, outcome,
// error, specific, 4 numbers, frames.
inline constexpr std::size_t lss_command_bytes = 36;
inline constexpr std::size_t lss_result_bytes = 24;
void pack(const LssCommand& command, std::span<std::byte, lss_command_bytes> bytes) noexcept;
void pack(const LssResult& result, std::span<std::byte, lss_result_bytes> bytes) noexcept;
/// None: no such service, or values that it can't have.
std::optional<LssCommand> unpack_lss_command(
    std::span<const std::byte, lss_command_bytes> bytes) noexcept;
LssResult unpack_lss_result(std::span<const std::byte, lss_result_bytes> bytes) noexcept;

/// "store configuration: the device does not support it (error 1)"; empty where it is done.
std::string lss_failure_text(const LssResult& result);

}  // namespace takt
