#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "master/wire/bytes.hpp"

namespace takt {

/// The origin of the time to live of a command.
enum class LimitOrigin : std::uint8_t {
  configured = 1,  ///< `on_timeout` of the network file
  command = 2,     ///< time_to_live of the message, which was shorter
};

/// The time to live that applied to the last command of an output.
struct CommandLimit {
  std::uint32_t cycles = 0;  ///< 0 means no limit
  LimitOrigin origin = LimitOrigin::configured;
};

/// Writes a limit into Event::bytes of `fallback_begun`.
constexpr std::array<std::uint8_t, 8> pack_limit(const CommandLimit& limit) noexcept {
  std::array<std::uint8_t, 8> bytes{};
  store_le(std::span{bytes}, limit.cycles);
  bytes[4] = static_cast<std::uint8_t>(limit.origin);
  return bytes;
}

/// Reads a limit that pack_limit() has written. Returns std::nullopt if the event has no limit. The
/// limit of the network file then applies.
constexpr std::optional<CommandLimit> unpack_limit(
    const std::array<std::uint8_t, 8>& bytes) noexcept {
  const auto origin = static_cast<LimitOrigin>(bytes[4]);
  if (origin != LimitOrigin::configured && origin != LimitOrigin::command) return {};
  return CommandLimit{.cycles = load_le<std::uint32_t>(std::span{bytes}), .origin = origin};
}

}  // namespace takt
