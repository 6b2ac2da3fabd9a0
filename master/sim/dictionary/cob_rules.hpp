#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"

namespace takt::sim {

inline constexpr std::uint32_t cob_invalid = 0x8000'0000;
inline constexpr std::uint32_t cob_bit30 = 0x4000'0000;
inline constexpr std::uint32_t cob_extended = 0x2000'0000;

/// Returns the identifier in a COB-ID entry of the dictionary.
constexpr CobId cob_id(std::uint64_t entry) noexcept {
  const auto raw = static_cast<std::uint32_t>(entry);
  return (raw & cob_extended) != 0 ? CobId::extended(raw & 0x1FFF'FFFF) : CobId::base(raw & 0x7FF);
}

/// Returns true if no configurable communication object may use this identifier. CiA 301, 7.3.5,
/// table 40.
constexpr bool is_restricted(CobId cob) noexcept {
  if (cob.is_extended()) return false;
  const std::uint32_t id = cob.id();
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
         (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

/// Returns true if the entry is marked as 11-bit but has bits of a 29-bit identifier set.
constexpr bool has_stray_bits(std::uint64_t entry) noexcept {
  return (entry & cob_extended) == 0 && (entry & 0x1FFF'F800) != 0;
}

}  // namespace takt::sim
