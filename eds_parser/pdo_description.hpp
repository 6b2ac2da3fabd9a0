#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// One entry of a PDO mapping. CiA 301, 7.5.2.36.
struct MappedObject {
  ObjectKey key;                 ///< index below 0x0020: a dummy
  std::uint8_t bits = 0;         ///< as the entry says; the dictionary may say otherwise
  std::uint16_t bit_offset = 0;  ///< in the PDO, from bit 0 of byte 0
  std::string name;              ///< of the mapped object; empty where the file does not have it

  bool is_dummy() const noexcept { return key.index < 0x0020; }
};

/// A PDO as the values of the file (of a DCF: its ParameterValues) set it up. Directions are the
/// device's: a TPDO is sent by the device.
struct PdoDescription {
  std::uint16_t number = 1;  ///< 1..512
  bool is_tpdo = false;
  std::optional<std::uint32_t> cob_id_raw;  ///< sub 1 with its flags; none: no value or no node id
  /// What is added to a node id that is not known: `$NODEID+0x180`; none: absolute, or known.
  std::optional<std::uint32_t> cob_id_offset;
  bool valid = false;        ///< bit 31 is clear
  bool rtr_allowed = false;  ///< bit 30 is clear
  bool extended = false;     ///< bit 29 is set
  std::optional<std::uint8_t> transmission_type;
  std::uint32_t inhibit_time_us = 0;
  std::uint16_t event_timer_ms = 0;
  std::optional<std::uint8_t> sync_start;     ///< none where the record has no sub 6
  std::optional<std::uint8_t> mapping_count;  ///< sub 0 of the mapping; none: no value
  unsigned bits = 0;                          ///< sum of the mapping, may exceed 64
  std::vector<MappedObject> mapping;          ///< the active entries

  /// CAN identifier without flags.
  std::optional<std::uint32_t> cob_id() const noexcept {
    if (!cob_id_raw) return std::nullopt;
    return *cob_id_raw & (extended ? 0x1FFF'FFFFU : 0x7FFU);
  }
  std::uint16_t communication_index() const noexcept {
    return static_cast<std::uint16_t>((is_tpdo ? 0x1800 : 0x1400) + number - 1);
  }
  std::uint16_t mapping_index() const noexcept {
    return static_cast<std::uint16_t>(communication_index() + 0x200);
  }
};

/// First mapping record whose count the device lets write; null where all mapping is fixed.
const Object* mappable_record(const ObjectDictionary& dictionary) noexcept;

/// All PDOs that have a communication record, RPDOs first, each in ascending number.
std::vector<PdoDescription> describe_pdos(const ObjectDictionary& dictionary);

}  // namespace takt
