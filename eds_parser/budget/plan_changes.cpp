#include "eds_parser/budget/plan_changes.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "eds_parser/report/message.hpp"

namespace takt {
namespace {

constexpr std::uint32_t first_pdo_id = 0x181;
constexpr std::uint32_t last_pdo_id = 0x57F;
constexpr std::uint8_t every_second = 2;
constexpr std::uint8_t even_counter = 240;
constexpr Time inhibit_unit = std::chrono::microseconds{100};
constexpr Time::rep longest_inhibit = 0xFFFF;

PdoChange change_of(const BusPlan& plan, const PdoRow& row) {
  return {.node = plan.nodes[row.node_index].name, .tpdo = true, .number = row.number};
}

/// Returns the step, in us, to which people usually round a period of this length.
std::uint32_t step_of(std::uint32_t period_us) {
  return period_us < 5'000 ? 50 : period_us < 20'000 ? 200 : 1'000;
}

bool is_event_driven(const PdoRow& row) { return !row.synchronous() && !row.multiplexed(); }

/// Returns the shortest time between two frames of this PDO that the budget assumes.
Time least_distance(const PdoRow& row, Time cycle) {
  if (row.inhibit > Time{0}) return row.inhibit;
  return row.event_timer > Time{0} ? std::min(row.event_timer, cycle) : cycle;
}

}  // namespace

std::string names_of(const std::vector<PdoChange>& changes) {
  std::string names;
  for (const auto& change : changes) {
    append_item(names, change.tpdo ? "TPDO" : "RPDO", change.number, ' ', change.node);
  }
  return names;
}

std::vector<PdoChange> lower_priorities(const BusPlan& plan) {
  if (!plan.cycle.sync) return {};
  std::set<std::uint32_t> used;
  std::uint32_t lowest = first_pdo_id;
  for (const auto* rows : {&plan.pdos.tpdos, &plan.pdos.rpdos}) {
    for (const auto& row : *rows) {
      used.insert(row.cob_id.id());
      const bool counts = row.synchronous() && !row.cob_id.is_extended();
      if (counts) lowest = std::max(lowest, row.cob_id.id());
    }
  }
  std::vector<PdoChange> moved;
  std::uint32_t next = last_pdo_id;
  for (const auto& row : plan.pdos.tpdos) {
    if (row.synchronous() || row.cob_id.is_extended() || row.cob_id.id() > lowest) continue;
    while (next > lowest && used.contains(next)) --next;
    if (next <= lowest) return {};
    auto change = change_of(plan, row);
    change.cob_id = next--;
    moved.push_back(std::move(change));
  }
  return moved;
}

Suggestion lower_priority_of(std::vector<PdoChange> pdos) {
  return {.text = "lower priority than all synchronous PDOs for " + names_of(pdos),
          .changes = {.pdos = std::move(pdos)}};
}

Suggestion by_turns(const BusPlan& plan, unsigned count) {
  std::vector<const PdoRow*> rows;
  for (const auto& row : plan.pdos.tpdos) {
    if (row.transmission == 1 && !row.multiplexed()) rows.push_back(&row);
  }
  if (!plan.cycle.sync || rows.size() < count) return {};
  std::ranges::sort(rows, std::ranges::greater{}, [](const PdoRow* row) { return row->cob_id; });
  WhatIf changes;
  for (std::size_t i = 0; i < count; ++i) {
    auto change = change_of(plan, *rows[i]);
    change.transmission = every_second;
    change.sync_start = static_cast<std::uint8_t>(1 + i % 2);
    changes.pdos.push_back(std::move(change));
  }
  const bool counted = plan.cycle.sync_overflow >= 2 && plan.cycle.sync_overflow % 2 == 0;
  if (!counted) changes.sync_overflow = even_counter;
  return {
      .text = "every second SYNC, alternately (SYNC with counter), for " + names_of(changes.pdos),
      .changes = std::move(changes)};
}

Suggestion longer_inhibits(const BusPlan& plan, unsigned factor) {
  std::vector<PdoChange> longer;
  for (const auto& row : plan.pdos.tpdos) {
    if (!is_event_driven(row)) continue;
    const Time now = least_distance(row, plan.cycle.period);
    const auto units = (now * factor + inhibit_unit - Time{1}) / inhibit_unit;
    auto change = change_of(plan, row);
    change.inhibit_time = static_cast<std::uint16_t>(std::min(units, longest_inhibit));
    longer.push_back(std::move(change));
  }
  return {.text = concat("inhibit times ", factor, " times as long for ", names_of(longer)),
          .changes = {.pdos = std::move(longer)}};
}

std::uint32_t round_period(std::uint32_t period_us) {
  const auto step = step_of(period_us);
  return (period_us + step - 1) / step * step;
}

Suggestion other_period(const BusPlan& plan, std::uint32_t period_us) {
  const auto now = std::chrono::ceil<std::chrono::microseconds>(plan.cycle.period).count();
  return {.text = concat("SYNC every ", period_us, " us instead of ", now, " us"),
          .changes = {.sync_period_us = period_us}};
}

Suggestion other_service_frames(const BusPlan& plan, std::uint16_t frames) {
  return {.text = concat("`service_frames: ", frames, "` instead of ", plan.cycle.service_frames),
          .changes = {.service_frames = frames}};
}

std::vector<Suggestion> higher_bitrates(const BusPlan& plan) {
  std::vector<Suggestion> higher;
  for (const std::uint16_t kbit : known_bitrates) {
    if (kbit * 1000U <= plan.bitrate) continue;
    higher.push_back({.text = concat(kbit, " kbit/s instead of ", plan.bitrate / 1000),
                      .changes = {.bitrate_kbit = kbit}});
  }
  return higher;
}

}  // namespace takt
