#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Index of a value in the process image.
using SignalIndex = std::uint16_t;

/// One mapped object: `bits` bits of the frame from `bit_offset` on, least significant bit first,
/// form one value of the image. Gaps and dummy entries have no field. CiA 301, 7.1.4 and 7.5.2.36.
struct PdoField {
  SignalIndex signal = 0;
  std::uint8_t bit_offset = 0;  ///< 0..63
  std::uint8_t bits = 0;        ///< 1..64
  bool sign_extend = false;
};

/// One PDO. TPDO and RPDO are named from the device's side: the master receives TPDOs. A
/// multiplexed PDO (MPDO) has one row for each object that it carries. CiA 301, 7.2.3.
struct PdoRow {
  CobId cob_id;
  NodeId node;
  std::uint8_t node_index = 0;    ///< position in BusPlan::nodes
  std::uint16_t number = 1;       ///< 1..512
  std::uint8_t transmission = 1;  ///< 0..240, 252..255; CiA 301, tables 69 and 72
  std::uint8_t length = 0;        ///< bytes, 0..8
  std::uint8_t sync_start = 0;    ///< SYNC counter of the first transmission; 0 = any
  std::uint16_t first_field = 0;  ///< fields [first_field, first_field + field_count) of the table
  std::uint16_t field_count = 0;
  Time inhibit{};      ///< inhibit time: shortest distance between two event-driven frames
  Time event_timer{};  ///< TPDO: longest silence of the device; RPDO: period of repetition
  Time deadline{};     ///< silence after which the PDO counts as missing; 0 = not watched
  Time poll{};         ///< TPDO: period of the master's remote requests; 0 = none
  std::uint16_t poll_syncs = 0;  ///< TPDO: remote request at every n-th SYNC; 0 = none
  std::uint32_t header = 0;      ///< MPDO: bytes 0..3 of its frames, little endian; 0 = not an MPDO
  /// Received MPDO: number of rows with this COB-ID, this one included, which follow each other in
  /// ascending order of `header`. 0 if this is not the first of them.
  std::uint16_t siblings = 0;
  bool on_request = false;  ///< not in the image: sent and awaited by requests only
  bool drop_late = false;   ///< TPDO: the master ignores a synchronous frame after its window

  constexpr bool multiplexed() const noexcept { return header != 0; }
  constexpr bool synchronous() const noexcept { return transmission <= 240; }
  /// Types 1..240 are expected in fixed cycles. Types 0, 254 and 255 only have a deadline.
  constexpr bool cyclic() const noexcept { return transmission >= 1 && transmission <= 240; }
};

/// The PDOs of a bus as flat tables. The bus thread uses them to copy values between frames and
/// image.
struct PdoTable {
  static constexpr std::uint16_t no_row = 0xFFFF;

  std::vector<PdoRow> tpdos;     ///< received by the master
  std::vector<PdoRow> rpdos;     ///< sent by the master, in sending order
  std::vector<PdoField> fields;  ///< fields of all TPDOs and RPDOs
  /// Maps an 11-bit COB-ID to its row of `tpdos`, or to no_row. 29-bit identifiers are searched in
  /// `tpdos`.
  std::array<std::uint16_t, 2048> route = [] {
    std::array<std::uint16_t, 2048> empty{};
    empty.fill(no_row);
    return empty;
  }();

  std::span<const PdoField> fields_of(const PdoRow& row) const noexcept {
    return std::span{fields}.subspan(row.first_field, row.field_count);
  }
};

/// Returns the TPDO that carries an input, or null if there is none.
inline const PdoRow* tpdo_of(const PdoTable& pdos, SignalIndex input) noexcept {
  for (const PdoRow& pdo : pdos.tpdos) {
    const auto fields = pdos.fields_of(pdo);
    if (std::ranges::find(fields, input, &PdoField::signal) != fields.end()) return &pdo;
  }
  return nullptr;
}

/// Returns true if the device sends this TPDO only on events, so that the first one may never come.
constexpr bool comes_by_event_alone(const PdoRow& tpdo) noexcept {
  return tpdo.transmission >= 254 && tpdo.event_timer == Time{};
}

}  // namespace takt
