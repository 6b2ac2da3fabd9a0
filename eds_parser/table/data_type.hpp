#pragma once
#include <cstdint>
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

/// Width in bits; 0 if the type has no fixed width (strings, domains, unknown codes).
constexpr unsigned bit_width(DataType type) noexcept {
  switch (type) {
    case DataType::boolean:
      return 1;
    case DataType::integer8:
    case DataType::unsigned8:
      return 8;
    case DataType::integer16:
    case DataType::unsigned16:
      return 16;
    case DataType::integer24:
    case DataType::unsigned24:
      return 24;
    case DataType::integer32:
    case DataType::unsigned32:
    case DataType::real32:
      return 32;
    case DataType::integer40:
    case DataType::unsigned40:
      return 40;
    case DataType::integer48:
    case DataType::unsigned48:
    case DataType::time_of_day:
    case DataType::time_difference:
      return 48;
    case DataType::integer56:
    case DataType::unsigned56:
      return 56;
    case DataType::integer64:
    case DataType::unsigned64:
    case DataType::real64:
      return 64;
    case DataType::unknown:
    case DataType::visible_string:
    case DataType::octet_string:
    case DataType::unicode_string:
    case DataType::domain:
      return 0;
  }
  return 0;
}

/// Number of bytes in an SDO transfer (a BOOLEAN takes one byte); 0 if the width is not fixed.
constexpr unsigned byte_width(DataType type) noexcept { return (bit_width(type) + 7) / 8; }

constexpr bool is_signed(DataType type) noexcept {
  switch (type) {
    case DataType::integer8:
    case DataType::integer16:
    case DataType::integer24:
    case DataType::integer32:
    case DataType::integer40:
    case DataType::integer48:
    case DataType::integer56:
    case DataType::integer64:
      return true;
    default:
      return false;
  }
}

constexpr bool is_real(DataType type) noexcept {
  return type == DataType::real32 || type == DataType::real64;
}

/// Whether a value is a byte sequence of any length: strings, domains and unknown codes.
constexpr bool is_bytes(DataType type) noexcept { return bit_width(type) == 0; }

/// Returns the name in CiA 301, for example `INTEGER32`, or `unknown` for other codes.
std::string_view name(DataType type) noexcept;

}  // namespace takt
