#include "eds_parser/ini/fitted_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace takt {
namespace {

/// Returns the signed number that a bit pattern of `bits` bits represents.
std::int64_t sign_extend(std::uint64_t pattern, unsigned bits) noexcept {
  const unsigned shift = 64 - bits;
  return std::bit_cast<std::int64_t>(pattern << shift) >> shift;
}

}  // namespace

std::uint64_t highest_unsigned(unsigned bits) noexcept {
  return bits >= 64 ? std::numeric_limits<std::uint64_t>::max() : (std::uint64_t{1} << bits) - 1;
}

FittedNumber fit_signed(const ParsedNumber& number, unsigned bits) noexcept {
  const std::uint64_t half = std::uint64_t{1} << (bits - 1);
  if (number.negative) {
    if (number.magnitude > half) return {};
    return {static_cast<std::int64_t>(~number.magnitude + 1), false};
  }
  if (number.magnitude < half) return {static_cast<std::int64_t>(number.magnitude), false};
  if (number.magnitude > highest_unsigned(bits)) return {};
  return {sign_extend(number.magnitude, bits), true};
}

FittedNumber fit_unsigned(const ParsedNumber& number, unsigned bits) noexcept {
  const std::uint64_t highest = highest_unsigned(bits);
  if (!number.negative) {
    if (number.magnitude > highest) return {};
    return {number.magnitude, false};
  }
  if (number.magnitude > (std::uint64_t{1} << (bits - 1))) return {};
  return {(~number.magnitude + 1) & highest, true};
}

std::optional<double> fit_real32(double value) noexcept {
  constexpr double highest = std::numeric_limits<float>::max();
  constexpr double rounds_to_infinity = 0x1.ffffffp127;
  if (std::abs(value) >= rounds_to_infinity) return std::nullopt;
  return std::clamp(value, -highest, highest);
}

bool resolve(ParsedNumber& number, std::optional<NodeId> node) noexcept {
  if (!number.relative()) return true;
  if (!node) return false;
  const std::uint64_t offset = std::uint64_t{node->value()} * number.node_ids;
  if (!number.negative) {
    if (number.magnitude > std::numeric_limits<std::uint64_t>::max() - offset) return false;
    number.magnitude += offset;
  } else if (number.magnitude >= offset) {
    number.magnitude -= offset;
  } else {
    number.magnitude = offset - number.magnitude;
    number.negative = false;
  }
  return true;
}

}  // namespace takt
