#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/pdo_number.hpp"

namespace takt {

struct DeviceData;

/// A node of the network file together with its device description and its device data. All of them
/// must outlive the compilation.
struct NodeSource {
  const NodeSpec* spec = nullptr;
  const ObjectDictionary* dictionary = nullptr;
  NodeId id;
  const DeviceData* data = nullptr;  ///< nullptr if only the EDS describes the device
  std::optional<Firmware> firmware{};
};

/// One mapped object of an effective PDO.
struct EffectiveEntry {
  ObjectKey object;
  std::uint8_t bits = 0;
  std::uint8_t bit_offset = 0;
  bool dummy = false;
  DataType type = DataType::unknown;
  std::string name{};  ///< name in the EDS
  SourcePos pos;       ///< place in the network file that asks for the object, or place of the node

  /// Returns the entry as 0x1600 or 0x1A00 holds it.
  std::uint32_t raw() const noexcept {
    return (std::uint32_t{object.index} << 16) | (std::uint32_t{object.sub} << 8) | bits;
  }
};

/// The way in which takt uses a PDO.
enum class PdoUse : std::uint8_t {
  exchanged,  ///< The PDO is part of the process image.
  linked,     ///< Another device sends this RPDO.
  off,        ///< The network file switches the PDO off.
  ignored,    ///< The PDO is off in the EDS, or takt does not support its kind.
};

/// The origin of the COB-ID of a PDO. A lower enumerator has a stronger claim to the COB-ID.
enum class CobIdOrigin : std::uint8_t { network_file, device_file, automatic };

/// A PDO as it will be on the bus: the settings of the device file, overlaid by the network file.
struct EffectivePdo : PdoNumber {
  PdoUse use = PdoUse::exchanged;
  bool named = false;          ///< The network file mentions the PDO.
  bool fixed_mapping = false;  ///< The mapping of the device can be compared but not written.
  CobId cob_id;
  CobIdOrigin origin = CobIdOrigin::device_file;
  bool has_cob_id = false;  ///< If false, assign_cob_ids() has not assigned one yet.
  std::uint8_t transmission = 255;
  std::uint16_t inhibit_time = 0;  ///< value of sub-index 3, in units of inhibit_unit_us
  std::uint32_t inhibit_unit_us = 100;
  std::uint16_t event_timer = 0;  ///< ms, sub-index 5 of the device
  std::uint8_t sync_start = 0;    ///< sub-index 6
  bool has_inhibit = false;       ///< The device has a writable sub-index 3.
  bool has_event_timer = false;
  bool has_sync_start = false;
  /// TPDO: deadline of the master in ms. RPDO: the master repeats the PDO after this time in ms.
  std::uint16_t master_timer = 0;
  std::uint16_t master_inhibit = 0;  ///< 100 us, RPDO only
  /// TPDO: period of the remote requests of the master in ms. 0 means none.
  std::uint32_t poll_ms = 0;
  std::uint16_t poll_syncs = 0;  ///< TPDO: a remote request at every n-th SYNC; 0 means none
  bool rtr = false;              ///< The device must allow remote requests.
  bool drop_late = false;
  bool on_request = false;  ///< The PDO is sent and expected only on request.
  Mpdo mpdo = Mpdo::none;
  /// Entries of the mapping; for an MPDO, the objects that it carries.
  std::vector<EffectiveEntry> mapping;
  unsigned bits = 0;
  SourcePos pos;         ///< place of the PDO in the network file, or of its node
  SourcePos cob_id_pos;  ///< place of `cob_id`, or the same as `pos`

  std::uint8_t bytes() const noexcept { return static_cast<std::uint8_t>((bits + 7) / 8); }
  bool synchronous() const noexcept { return transmission <= 240; }
  /// Returns true if another device or the master sends the frames of this PDO.
  bool is_used() const noexcept { return use == PdoUse::exchanged || use == PdoUse::linked; }
  bool maps(ObjectKey object) const noexcept {
    return std::ranges::find(mapping, object, &EffectiveEntry::object) != mapping.end();
  }
  /// Returns the entries that the mapping record must hold. An MPDO has none: sub-index 0 of its
  /// mapping record holds the code of the MPDO kind in place of a number of entries.
  std::span<const EffectiveEntry> entries() const noexcept {
    return mpdo == Mpdo::none ? std::span<const EffectiveEntry>{mapping}
                              : std::span<const EffectiveEntry>{};
  }
  std::int64_t mapping_count() const noexcept {
    if (mpdo == Mpdo::sam) return 0xFE;
    return mpdo == Mpdo::dam ? 0xFF : static_cast<std::int64_t>(mapping.size());
  }
  using PdoNumber::label;
  /// Returns the name with that of the node: "TPDO2 of node `arm`".
  std::string label(const NodeSpec& node) const { return label() + " of node `" + node.name + "`"; }
};

}  // namespace takt
