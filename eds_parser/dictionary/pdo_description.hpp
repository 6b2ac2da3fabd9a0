#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/values/pdo_number.hpp"

namespace takt {

/// One entry of a PDO mapping. CiA 301, 7.5.2.36.
struct MappedObject {
  ObjectKey key;                 ///< an index below 0x0020 is a dummy
  std::uint8_t sub = 0;          ///< sub-index of the entry in the mapping record
  std::uint8_t bits = 0;         ///< width in the entry; the dictionary may state another width
  std::uint16_t bit_offset = 0;  ///< position in the PDO, counted from bit 0 of byte 0
  std::string name;  ///< name of the mapped object; empty if the file does not describe it

  bool is_dummy() const noexcept { return key.index < 0x0020; }
};

/// A PDO as the values of the file configure it; for a DCF these are its ParameterValues.
/// Directions are those of the device: the device sends a TPDO.
struct PdoDescription : PdoNumber {
  /// The value of sub-index 1 with its flags. It is empty if the file has no value, or if the value
  /// needs an unknown node-ID.
  std::optional<std::uint32_t> cob_id_raw;
  /// The number that is added to an unknown node-ID, as in `$NODEID+0x180`. Empty if the COB-ID is
  /// absolute or the node-ID is known.
  std::optional<std::uint32_t> cob_id_offset;
  bool valid = false;        ///< bit 31 is clear
  bool rtr_allowed = false;  ///< bit 30 is clear
  bool extended = false;     ///< bit 29 is set
  std::optional<std::uint8_t> transmission_type;
  std::uint32_t inhibit_time_us = 0;
  std::uint16_t event_timer_ms = 0;
  std::optional<std::uint8_t> sync_start;     ///< empty if the record has no sub 6
  std::optional<std::uint8_t> mapping_count;  ///< sub 0 of the mapping; empty if it has no value
  unsigned bits = 0;                          ///< sum of the mapped bits, may exceed 64
  std::vector<MappedObject> mapping;          ///< the active entries

  /// Returns the CAN identifier without flags.
  std::optional<std::uint32_t> cob_id() const noexcept {
    if (!cob_id_raw) return std::nullopt;
    return *cob_id_raw & (extended ? 0x1FFF'FFFFU : 0x7FFU);
  }
};

/// Returns the first mapping record whose number of entries is writable, or nullptr if every
/// mapping is fixed.
const Object* mappable_record(const ObjectDictionary& dictionary) noexcept;

/// Returns all PDOs that have a communication record: first the RPDOs, then the TPDOs, each in
/// ascending number.
std::vector<PdoDescription> describe_pdos(const ObjectDictionary& dictionary);

}  // namespace takt
