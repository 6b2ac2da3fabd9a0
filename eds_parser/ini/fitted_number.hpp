#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/number.hpp"

namespace takt {

/// A number converted to the value of an integer type.
struct FittedNumber {
  std::optional<Value> value;  ///< empty if the type cannot hold the number
  /// A bit pattern for a signed type, or a negative number for an unsigned type.
  bool wrapped = false;
};

/// Returns 2^bits - 1, for 1..64 bits.
std::uint64_t highest_unsigned(unsigned bits) noexcept;
/// Converts to a signed type of 1..64 bits. A number above the range is taken for the bit pattern
/// of a negative number.
FittedNumber fit_signed(const ParsedNumber& number, unsigned bits) noexcept;
/// Converts to an unsigned type of 1..64 bits. A negative number becomes its bit pattern.
FittedNumber fit_unsigned(const ParsedNumber& number, unsigned bits) noexcept;
/// Returns std::nullopt if the nearest REAL32 is infinite. Values slightly above the largest REAL32
/// become that number, because its decimal texts are rounded upwards.
std::optional<double> fit_real32(double value) noexcept;
/// Adds the terms $NODEID. Returns false if the node-ID is needed but unknown, or if the sum needs
/// more than 64 bits.
bool resolve(ParsedNumber& number, std::optional<NodeId> node) noexcept;

}  // namespace takt
