#pragma once
#include <optional>

#include "eds_parser/budget/what_if.hpp"
#include "test/budget/hand_made_bus.hpp"

namespace takt {

inline void apply(const PdoChange& change, PdoRow& row) {
  if (change.cob_id) row.cob_id = CobId::base(*change.cob_id);
  if (change.transmission) row.transmission = *change.transmission;
  if (change.sync_start) row.sync_start = *change.sync_start;
  if (change.inhibit_time) row.inhibit = *change.inhibit_time * std::chrono::microseconds{100};
}

/// Returns the plan that a network file with these values would give.
inline std::optional<BusPlan> changed(BusPlan plan, const WhatIf& changes) {
  if (changes.sync_period_us) {
    plan.cycle.period = std::chrono::microseconds{*changes.sync_period_us};
  }
  if (changes.bitrate_kbit) plan.bitrate = *changes.bitrate_kbit * 1000U;
  if (changes.sync_overflow) plan.cycle.sync_overflow = *changes.sync_overflow;
  for (const auto& pdo : changes.pdos) {
    for (auto& row : pdo.tpdo ? plan.pdos.tpdos : plan.pdos.rpdos) {
      const bool same = plan.nodes[row.node_index].name == pdo.node && row.number == pdo.number;
      if (same) apply(pdo, row);
    }
  }
  compile(plan);
  if (changes.service_frames) plan.cycle.service_frames = *changes.service_frames;
  return plan;
}

}  // namespace takt
