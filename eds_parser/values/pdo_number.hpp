#pragma once
#include <cstdint>
#include <string>

#include "eds_parser/values/ids.hpp"

namespace takt {

/// Returns true for the communication record of an RPDO or TPDO.
constexpr bool is_pdo_communication(std::uint16_t index) noexcept {
  return (index & 0xFE00) == 0x1400 || (index & 0xFE00) == 0x1800;
}

/// Returns true for the mapping record of an RPDO or TPDO.
constexpr bool is_pdo_mapping(std::uint16_t index) noexcept {
  return (index & 0xFE00) == 0x1600 || (index & 0xFE00) == 0x1A00;
}

constexpr bool is_pdo_parameter(std::uint16_t index) noexcept {
  return is_pdo_communication(index) || is_pdo_mapping(index);
}

constexpr bool is_pdo_cob_id(ObjectKey key) noexcept {
  return key.sub == 1 && is_pdo_communication(key.index);
}

/// A PDO of a device by its number, and the indexes of its records.
struct PdoNumber {
  std::uint16_t number = 1;  ///< 1..512
  bool is_tpdo = false;

  constexpr std::uint16_t communication_index() const noexcept {
    return static_cast<std::uint16_t>((is_tpdo ? 0x1800 : 0x1400) + number - 1);
  }
  constexpr std::uint16_t mapping_index() const noexcept {
    return static_cast<std::uint16_t>(communication_index() + 0x200);
  }
  /// Returns the name for messages: `TPDO2`.
  std::string label() const { return (is_tpdo ? "TPDO" : "RPDO") + std::to_string(number); }
};

}  // namespace takt
