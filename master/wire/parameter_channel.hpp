#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "master/wire/bytes.hpp"

namespace takt {

/// Access to the parameters of a frequency converter over a pair of PDOs, as the CANopen cards of
/// INVT's GD family (Astraada DRV-28) offer it: RPDO1 carries the request, TPDO1 the answer. All
/// numbers are little endian.
namespace parameter_channel {

using Bytes8 = std::array<std::uint8_t, 8>;

enum class Command : std::uint16_t { read = 1, write = 2 };

/// An answer of the converter.
struct Answer {
  /// The converter has executed the command; otherwise `error` is valid.
  bool done = false;
  std::uint16_t error = 0;  ///< 0 means no error; error_text() describes it
  std::uint32_t value = 0;
};

/// Makes the data of RPDO1.
constexpr Bytes8 request(Command command, std::uint16_t address, std::uint32_t value) noexcept {
  Bytes8 bytes{};
  store_le(std::span{bytes}.first(2), static_cast<std::uint16_t>(command));
  store_le(std::span{bytes}.subspan(2, 2), address);
  store_le(std::span{bytes}.subspan(4, 4), value);
  return bytes;
}

/// Decodes the data of TPDO1. Returns std::nullopt if they are no answer (fewer than eight bytes,
/// or the code is neither "done" nor "error").
constexpr std::optional<Answer> answer(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() < 8) return std::nullopt;
  const auto code = load_le<std::uint16_t>(bytes.first(2));
  if (code != 1 && code != 3) return std::nullopt;
  return Answer{.done = code == 1,
                .error = load_le<std::uint16_t>(bytes.subspan(2, 2)),
                .value = load_le<std::uint32_t>(bytes.subspan(4, 4))};
}

/// Describes the error code of an answer in words.
constexpr std::string_view error_text(std::uint16_t error) noexcept {
  constexpr std::array<std::string_view, 10> texts{"no error",
                                                   "invalid command",
                                                   "no such parameter address",
                                                   "value out of range",
                                                   "the operation failed",
                                                   "wrong password",
                                                   "the frame is malformed",
                                                   "the parameter is read-only",
                                                   "not allowed while the drive is running",
                                                   "the parameter is locked by a password"};
  return error < texts.size() ? texts[error] : "unknown error code";
}

}  // namespace parameter_channel
}  // namespace takt
