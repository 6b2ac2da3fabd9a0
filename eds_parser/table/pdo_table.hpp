#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// Position of a value in the process image.
using SignalIndex = std::uint16_t;

/// One mapped object: `bits` bits of the frame from `bit_offset` on, least significant first, are
/// one value of the image. Gaps and dummy entries have no field. CiA 301, 7.1.4 and 7.5.2.36.
struct PdoField {
  SignalIndex signal = 0;
  std::uint8_t bit_offset = 0;  ///< 0..63
  std::uint8_t bits = 0;        ///< 1..64
  bool sign_extend = false;
};

/// One PDO. TPDO and RPDO are named from the device's side: the master receives TPDOs. A
/// multiplexed PDO (MPDO) is one row for each object that it carries. CiA 301, 7.2.3.
struct PdoRow {
  CobId cob_id;
  NodeId node;
  std::uint8_t node_index = 0;    ///< position in BusPlan::nodes
  std::uint16_t number = 1;       ///< 1..512
  std::uint8_t transmission = 1;  ///< 0..240, 252..255; CiA 301, tables 69 and 72
  std::uint8_t length = 0;        ///< bytes, 0..8
  std::uint8_t sync_start = 0;    ///< SYNC counter of the first transmission, 0 = any
  std::uint16_t first_field = 0;  ///< fields [first_field, first_field + field_count) of the table
  std::uint16_t field_count = 0;
  Time inhibit{};      ///< smallest distance of two event-driven frames
  Time event_timer{};  ///< TPDO: longest silence of the device. RPDO: the master repeats after it
  Time deadline{};     ///< longer than this without a frame: missing. 0 = not watched
  Time poll{};         ///< TPDO: asked for by remote request so often. 0 = not
  std::uint16_t poll_syncs = 0;  ///< TPDO: asked for every n-th SYNC. 0 = not
  std::uint32_t header = 0;      ///< MPDO: bytes 0..3 of its frames, little endian; 0: no MPDO
  /// MPDO, received: so many rows from here on have this COB-ID, in ascending header; 0: not the
  /// first of them.
  std::uint16_t siblings = 0;
  bool on_request = false;  ///< no part of the image: sent and awaited by requests only
  bool drop_late = false;   ///< TPDO: a synchronous frame after its window is not used

  constexpr bool multiplexed() const noexcept { return header != 0; }
  constexpr bool synchronous() const noexcept { return transmission <= 240; }
  /// Expected in fixed cycles: types 1..240. Type 0, 254 and 255 only have a deadline.
  constexpr bool cyclic() const noexcept { return transmission >= 1 && transmission <= 240; }
};

/// The PDOs of a bus as flat copy programs.
struct PdoTable {
  static constexpr std::uint16_t no_row = 0xFFFF;

  std::vector<PdoRow> tpdos;     ///< received by the master
  std::vector<PdoRow> rpdos;     ///< sent by the master, in sending order
  std::vector<PdoField> fields;  ///< of both
  /// 11-bit COB-ID -> row of `tpdos`, else no_row. 29-bit identifiers are searched in `tpdos`.
  std::array<std::uint16_t, 2048> route = [] {
    std::array<std::uint16_t, 2048> empty{};
    empty.fill(no_row);
    return empty;
  }();
};

}  // namespace takt
