#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/network_spec.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/table/data_type.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

struct DeviceData;

/// A node of the network file beside its device description and its device data. All outlive the
/// compilation.
struct NodeSource {
  const NodeSpec* spec = nullptr;
  const ObjectDictionary* dictionary = nullptr;
  NodeId id;
  const DeviceData* data = nullptr;  ///< nullptr: nothing is known beside the EDS
  std::optional<Firmware> firmware{};
};

/// One mapped object of an effective PDO.
struct EffectiveEntry {
  ObjectKey object;
  std::uint8_t bits = 0;
  std::uint8_t bit_offset = 0;
  bool dummy = false;
  DataType type = DataType::unknown;
  std::string name;  ///< EDS name
  SourcePos pos;     ///< where the network file asks for it, or its node

  /// As 0x1600/0x1A00 hold it.
  std::uint32_t raw() const noexcept {
    return (std::uint32_t{object.index} << 16) | (std::uint32_t{object.sub} << 8) | bits;
  }
};

/// What becomes of a PDO.
enum class PdoUse : std::uint8_t {
  exchanged,  ///< in the image
  linked,     ///< an RPDO that another device feeds
  off,        ///< the network file switches it off
  ignored,    ///< off in the EDS, or of a kind that takt leaves alone
};

/// Where the COB-ID of a PDO comes from; the lower, the stronger its claim.
enum class CobIdOrigin : std::uint8_t { network_file, device_file, automatic };

/// A PDO as it will be on the bus: the device file overlaid by the network file.
struct EffectivePdo {
  std::uint16_t number = 1;
  bool is_tpdo = false;
  PdoUse use = PdoUse::exchanged;
  bool named = false;          ///< the network file has a word on it
  bool fixed_mapping = false;  ///< the device's mapping can only be compared
  CobId cob_id;
  CobIdOrigin origin = CobIdOrigin::device_file;
  bool has_cob_id = false;  ///< false: still to be assigned
  std::uint8_t transmission = 255;
  std::uint16_t inhibit_time = 0;  ///< as sub 3 holds it, in inhibit_unit_us
  std::uint32_t inhibit_unit_us = 100;
  std::uint16_t event_timer = 0;  ///< ms, sub 5 of the device
  std::uint8_t sync_start = 0;    ///< sub 6
  bool has_inhibit = false;       ///< the device has a writable sub 3; sub 5; sub 6
  bool has_event_timer = false;
  bool has_sync_start = false;
  std::uint16_t master_timer = 0;    ///< ms: TPDO: the master's deadline; RPDO: repeat after it
  std::uint16_t master_inhibit = 0;  ///< 100 us, RPDO
  std::uint32_t poll_ms = 0;         ///< TPDO: remote requests of the master, 0 = none
  std::uint16_t poll_syncs = 0;      ///< the same, every n-th SYNC
  bool rtr = false;                  ///< remote requests have to be allowed
  bool drop_late = false;
  bool on_request = false;  ///< sent and awaited by requests only
  Mpdo mpdo = Mpdo::none;
  std::vector<EffectiveEntry> mapping;  ///< of an MPDO: the objects it carries
  unsigned bits = 0;
  SourcePos pos;         ///< of the PDO in the network file, or of its node
  SourcePos cob_id_pos;  ///< of `cob_id`, or as `pos`

  std::uint16_t communication_index() const noexcept {
    return static_cast<std::uint16_t>((is_tpdo ? 0x1800 : 0x1400) + number - 1);
  }
  std::uint16_t mapping_index() const noexcept {
    return static_cast<std::uint16_t>(communication_index() + 0x200);
  }
  std::uint8_t bytes() const noexcept { return static_cast<std::uint8_t>((bits + 7) / 8); }
  bool synchronous() const noexcept { return transmission <= 240; }
  /// Entries that the mapping record has to hold; an MPDO has its mark in place of their number.
  std::span<const EffectiveEntry> entries() const noexcept {
    return mpdo == Mpdo::none ? std::span<const EffectiveEntry>{mapping}
                              : std::span<const EffectiveEntry>{};
  }
  std::int64_t mapping_count() const noexcept {
    if (mpdo == Mpdo::sam) return 0xFE;
    return mpdo == Mpdo::dam ? 0xFF : static_cast<std::int64_t>(mapping.size());
  }
  /// `TPDO2`.
  std::string label() const { return (is_tpdo ? "TPDO" : "RPDO") + std::to_string(number); }
};

}  // namespace takt
