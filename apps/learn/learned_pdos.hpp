#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/learn/learned_bus.hpp"

namespace takt {

/// A PDO as a recorded boot left it; nothing in it: the recording does not say.
struct LearnedPdo {
  std::uint16_t number = 1;
  bool is_tpdo = false;
  std::optional<std::uint32_t> cob_id;  ///< with its flags, as sub 1 holds it
  std::optional<std::uint8_t> transmission;
  std::optional<std::uint16_t> inhibit_time;  ///< 100 us
  std::optional<std::uint16_t> timer;         ///< ms, sub 5
  std::optional<std::uint8_t> sync_start;
  std::optional<std::uint8_t> count;                  ///< sub 0 of the mapping
  std::optional<std::vector<std::uint32_t>> mapping;  ///< all entries that count; never empty
  bool enabled() const noexcept { return !cob_id || (*cob_id & 0x8000'0000U) == 0; }
  std::optional<CobId> identifier() const noexcept;
};

/// PDOs of which the recording shows any parameter: RPDOs, then TPDOs, ascending.
std::vector<LearnedPdo> learned_pdos(const LearnedValues& values);

/// The records of PDOs, in both directions, communication and mapping.
constexpr bool is_pdo_object(std::uint16_t index) noexcept {
  return index >= 0x1400 && index <= 0x1BFF;
}

}  // namespace takt
