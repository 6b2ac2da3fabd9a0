#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/number.hpp"
#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// A number as the value of an integer type.
struct FittedNumber {
  std::optional<Value> value;  ///< none: the type cannot hold it
  bool wrapped = false;  ///< a bit pattern for a signed type, or a negative number for an unsigned
};

/// 2^bits - 1, of 1..64 bits.
std::uint64_t highest_unsigned(unsigned bits) noexcept;
/// Of 1..64 bits; a number above the type is taken for the bit pattern of a negative one.
FittedNumber fit_signed(const ParsedNumber& number, unsigned bits) noexcept;
/// Of 1..64 bits; a negative number becomes its bit pattern.
FittedNumber fit_unsigned(const ParsedNumber& number, unsigned bits) noexcept;
/// None where the nearest REAL32 is infinite; decimal texts of the largest are rounded upwards.
std::optional<double> fit_real32(double value) noexcept;
/// Adds the terms $NODEID; false where the node id is needed and unknown, or the sum needs more
/// than 64 bits.
bool resolve(ParsedNumber& number, std::optional<NodeId> node) noexcept;

}  // namespace takt
