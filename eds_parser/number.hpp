#pragma once
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

namespace takt {

/// What was unusual about a number that could be read all the same.
enum class NumberQuirk : std::uint16_t {
  octal = 0x01,              ///< leading 0: read as octal, as CiA 306 says
  decimal_zero = 0x02,       ///< leading 0 before an 8 or 9: read as decimal
  suffix = 0x04,             ///< `0x10UL`
  node_id_not_first = 0x08,  ///< `0x80+$NODEID`
  node_id_no_dollar = 0x10,  ///< `NODEID+0x80`
  hex_without_prefix = 0x20,
  fraction = 0x40,  ///< `5.0` for an integer
  comment = 0x80,   ///< `0x10 ; text`
  word = 0x100,     ///< `true`, `yes` ...
};

/// Integer with sign, or a sum in which the node id is a term.
struct ParsedNumber {
  std::uint64_t magnitude = 0;
  bool negative = false;
  std::uint8_t node_ids = 0;  ///< how often $NODEID is added
  bool hex = false;           ///< some term was written in hex: may be a bit pattern
  std::uint16_t quirks = 0;

  bool has(NumberQuirk quirk) const noexcept {
    return (quirks & static_cast<std::uint16_t>(quirk)) != 0;
  }
  bool relative() const noexcept { return node_ids != 0; }
};

enum class NumberFault : std::uint8_t {
  empty,         ///< nothing written: no value, not a fault of the file
  not_a_number,  ///< `-`, `abc`, `3.14`, `$NODEID-1`
  unknown_name,  ///< `$MY_NODE_ID+0x80`
  too_big,       ///< more than 64 bits
};

/// `0x1F`, `31`, `037`, `-5`, `$NODEID+0x180` and their relatives: terms in any order, blanks and
/// case do not matter. CiA 306, 4.3 and what vendors make of it.
std::expected<ParsedNumber, NumberFault> parse_number(std::string_view text) noexcept;

/// Decimal number with or without exponent, `nan`, `inf`.
std::optional<double> parse_real(std::string_view text) noexcept;

}  // namespace takt
