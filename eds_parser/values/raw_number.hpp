#pragma once
#include <bit>
#include <cstdint>

#include "eds_parser/values/data_type.hpp"

namespace takt {

/// Returns the `bits` low bits of `raw` as a signed number.
constexpr std::int64_t sign_extended(std::uint64_t raw, unsigned bits) noexcept {
  if (bits == 0 || bits >= 64) return static_cast<std::int64_t>(raw);
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>(raw << unused) >> unused;
}

/// Returns the number that an image value represents, without scale.
constexpr double number_of(DataType type, std::int64_t raw) noexcept {
  if (type == DataType::real32) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  if (type == DataType::real64) return std::bit_cast<double>(raw);
  if (type == DataType::unsigned64) return static_cast<double>(static_cast<std::uint64_t>(raw));
  return static_cast<double>(raw);
}

}  // namespace takt
