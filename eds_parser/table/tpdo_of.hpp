#pragma once
#include <algorithm>
#include <span>

#include "eds_parser/table/pdo_table.hpp"

namespace takt {

/// Returns the TPDO that carries an input, or null if there is none.
inline const PdoRow* tpdo_of(const PdoTable& pdos, SignalIndex input) noexcept {
  for (const PdoRow& pdo : pdos.tpdos) {
    const auto fields = std::span{pdos.fields}.subspan(pdo.first_field, pdo.field_count);
    if (std::ranges::find(fields, input, &PdoField::signal) != fields.end()) return &pdo;
  }
  return nullptr;
}

/// Whether the device sends this TPDO only on events, so that the first one may never come.
constexpr bool comes_by_event_alone(const PdoRow& tpdo) noexcept {
  return tpdo.transmission >= 254 && tpdo.event_timer == Time{};
}

}  // namespace takt
