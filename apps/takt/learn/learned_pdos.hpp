#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/takt/learn/learned_bus.hpp"
#include "eds_parser/values/pdo_number.hpp"

namespace takt::learn {

/// A PDO as a recorded boot left it. A parameter is empty if the recording does not show it.
struct LearnedPdo : PdoNumber {
  std::optional<std::uint32_t> cob_id{};  ///< value of sub-index 1 with its flags
  std::optional<std::uint8_t> transmission{};
  std::optional<std::uint16_t> inhibit_time{};  ///< multiples of 100 us
  std::optional<std::uint16_t> timer{};         ///< sub-index 5, ms
  std::optional<std::uint8_t> sync_start{};
  std::optional<std::uint8_t> count{};                  ///< sub-index 0 of the mapping
  std::optional<std::vector<std::uint32_t>> mapping{};  ///< the first `count` entries; never empty
  bool enabled() const noexcept { return !cob_id || (*cob_id & 0x8000'0000U) == 0; }
  std::optional<CobId> identifier() const noexcept;
};

/// Returns the object of an entry of a mapping. Its lowest eight bits are the width.
constexpr ObjectKey mapped_object(std::uint32_t entry) noexcept {
  return {static_cast<std::uint16_t>(entry >> 16U), static_cast<std::uint8_t>(entry >> 8U & 0xFFU)};
}

/// Returns the PDOs of which the recording shows any parameter: first the RPDOs, then the TPDOs,
/// each in ascending order.
std::vector<LearnedPdo> learned_pdos(const LearnedValues& values);

}  // namespace takt::learn
