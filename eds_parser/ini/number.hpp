#pragma once
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

namespace takt {

/// A peculiarity of a number that could be read nevertheless.
enum class NumberQuirk : std::uint16_t {
  octal = 0x01,              ///< leading 0, read as octal as CiA 306 says
  decimal_zero = 0x02,       ///< leading 0 before an 8 or 9, read as decimal
  suffix = 0x04,             ///< `0x10UL`
  node_id_not_first = 0x08,  ///< `0x80+$NODEID`
  node_id_no_dollar = 0x10,  ///< `NODEID+0x80`
  hex_without_prefix = 0x20,
  fraction = 0x40,  ///< `5.0` for an integer
  comment = 0x80,   ///< `0x10 ; text`
  word = 0x100,     ///< `true`, `yes` ...
};

constexpr std::uint16_t quirk_bit(NumberQuirk quirk) noexcept {
  return static_cast<std::uint16_t>(quirk);
}

/// An integer with a sign, or a sum that contains the node-ID.
struct ParsedNumber {
  std::uint64_t magnitude = 0;
  bool negative = false;
  std::uint8_t node_ids = 0;  ///< number of times that $NODEID is added
  bool hex = false;  ///< A term was written in hexadecimal, so the number may be a bit pattern.
  std::uint16_t quirks = 0;

  bool has(NumberQuirk quirk) const noexcept { return (quirks & quirk_bit(quirk)) != 0; }
  bool relative() const noexcept { return node_ids != 0; }
  /// Returns true for a number of 0..`highest` without $NODEID.
  bool is_within(std::uint64_t highest) const noexcept {
    return !negative && !relative() && magnitude <= highest;
  }
};

enum class NumberFault : std::uint8_t {
  empty,         ///< The text is empty: there is no value, which is not a fault of the file.
  not_a_number,  ///< `-`, `abc`, `3.14`, `$NODEID-1`
  unknown_name,  ///< `$MY_NODE_ID+0x80`
  too_big,       ///< more than 64 bits
};

/// Reads `0x1F`, `31`, `037`, `-5`, `$NODEID+0x180` and similar forms. Terms may have any order;
/// blanks and case do not matter. CiA 306, 4.3, extended by the forms that vendors use.
std::expected<ParsedNumber, NumberFault> parse_number(std::string_view text) noexcept;

/// Reads a decimal number with or without exponent, `nan` or `inf`.
std::optional<double> parse_real(std::string_view text) noexcept;

/// Reads `true`, `yes`, `on` and their opposites, which occur in files written by hand.
std::optional<bool> boolean_word(std::string_view text) noexcept;

}  // namespace takt
