#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

namespace takt {

/// CANopen data types by their index in the dictionary. CiA 301, 7.4.7, table 44.
enum class DataType : std::uint16_t {
  unknown = 0x00,
  boolean = 0x01,
  integer8 = 0x02,
  integer16 = 0x03,
  integer32 = 0x04,
  unsigned8 = 0x05,
  unsigned16 = 0x06,
  unsigned32 = 0x07,
  real32 = 0x08,
  visible_string = 0x09,
  octet_string = 0x0A,
  unicode_string = 0x0B,
  time_of_day = 0x0C,
  time_difference = 0x0D,
  domain = 0x0F,
  integer24 = 0x10,
  real64 = 0x11,
  integer40 = 0x12,
  integer48 = 0x13,
  integer56 = 0x14,
  integer64 = 0x15,
  unsigned24 = 0x16,
  unsigned40 = 0x18,
  unsigned48 = 0x19,
  unsigned56 = 0x1A,
  unsigned64 = 0x1B,
};

/// Returns the width in bits; 0 if the type has no fixed width (strings, domains, unknown codes).
constexpr unsigned bit_width(DataType type) noexcept {
  // By index of the type: integers, REAL32, strings; times, DOMAIN; 24 to 64 bits.
  constexpr std::uint8_t bits[]{0, 1, 8,  16, 32, 8,  16, 32, 32, 0, 0,  0,  48, 48,
                                0, 0, 24, 64, 40, 48, 56, 64, 24, 0, 40, 48, 56, 64};
  const auto index = static_cast<std::size_t>(type);
  return index < std::size(bits) ? bits[index] : 0;
}

/// Returns the number of bytes in an SDO transfer (a BOOLEAN takes one byte); 0 if the width is not
/// fixed.
constexpr unsigned byte_width(DataType type) noexcept { return (bit_width(type) + 7) / 8; }

constexpr bool is_signed(DataType type) noexcept {
  const auto code = static_cast<unsigned>(type);
  return (code >= 0x02 && code <= 0x04) || code == 0x10 || (code >= 0x12 && code <= 0x15);
}

constexpr bool is_real(DataType type) noexcept {
  return type == DataType::real32 || type == DataType::real64;
}

constexpr bool is_time(DataType type) noexcept {
  return type == DataType::time_of_day || type == DataType::time_difference;
}

/// Returns true if a value is a byte sequence of any length: strings, domains and unknown codes.
constexpr bool is_bytes(DataType type) noexcept { return bit_width(type) == 0; }

/// Returns the name in CiA 301, for example `INTEGER32`, or `unknown` for other codes.
std::string_view name(DataType type) noexcept;

/// Returns true if this number is finite but too large for a REAL32, in which it would become
/// infinite.
constexpr bool exceeds_real32(double value) noexcept {
  constexpr double most = std::numeric_limits<float>::max();
  constexpr double largest = std::numeric_limits<double>::max();
  return (value > most && value <= largest) || (value < -most && value >= -largest);
}

}  // namespace takt
