#include "master/core/pdo_inputs.hpp"

namespace takt {

PdoInputs::PdoInputs(const BusPlan& plan, WorkingImage& image, EventQueue& events)
    : plan_{plan}, image_{image}, events_{events}, receptions_(plan.nodes.size()) {
  fields_.reserve(plan.pdos.fields.size());
  for (const PdoField& field : plan.pdos.fields) fields_.push_back(compile(field));
  rows_.reserve(plan.pdos.tpdos.size());
  for (const PdoRow& pdo : plan.pdos.tpdos) {
    Row row;
    row.first = pdo.first_field;
    row.count = pdo.field_count;
    row.number = pdo.number;
    row.length = pdo.length;
    row.node_index = pdo.node_index;
    row.every = plan.cycle.sync && pdo.cyclic() ? pdo.transmission : std::uint8_t{0};
    row.deadline = pdo.deadline;
    rows_.push_back(row);
    mark(rows_.back(), true);
  }
}

void PdoInputs::mark(Row& row, bool stale) noexcept {
  row.stale = stale;
  for (std::uint16_t i = 0; i < row.count; ++i) {
    image_.set_stale(fields_[row.first + i].signal, stale);
  }
}

void PdoInputs::tell(EventKind kind, const Row& row, Time now, std::uint32_t detail) noexcept {
  events_.push({.when = now,
                .cycle = cycle_,
                .kind = kind,
                .node = plan_.nodes[row.node_index].id.value(),
                .detail = detail,
                .value = row.number});
}

void PdoInputs::set_reception(std::size_t node_index, Reception reception, Time now) noexcept {
  if (receptions_[node_index] == reception) return;
  receptions_[node_index] = reception;
  for (Row& row : rows_) {
    if (row.node_index != node_index) continue;
    mark(row, true);
    row.known = false;
    row.misses = 0;
    row.waited = false;
    row.last_time = now;
    // The first frame may take up to n beats; 2 n is too long for every phase.
    const bool watched = reception != Reception::off && row.every != 0;
    row.due = watched ? beat_ + 2 * std::uint64_t{row.every} : not_due;
  }
}

void PdoInputs::begin(std::uint64_t cycle, Time sync, bool heard) noexcept {
  cycle_ = cycle;
  expected_ = 0;
  outstanding_ = 0;
  if (!heard) return;
  sync_ = sync;
  last_arrival_ = sync;
  ++beat_;
  for (Row& row : rows_) {
    row.waited = row.due == beat_ && row.known && row.misses < patience;
    expected_ += row.waited;
  }
  outstanding_ = expected_;
}

std::uint16_t PdoInputs::find(CobId id) const noexcept {
  if (!id.is_extended()) [[likely]] {
    return plan_.pdos.route[id.id() & 0x7FF];
  }
  for (std::size_t i = 0; i < plan_.pdos.tpdos.size(); ++i) {
    if (plan_.pdos.tpdos[i].cob_id == id) return static_cast<std::uint16_t>(i);
  }
  return PdoTable::no_row;
}

bool PdoInputs::check_length(Row& row, const StampedFrame& stamped) noexcept {
  if (stamped.frame.length == row.length) [[likely]] {
    row.odd_length = false;
    return true;
  }
  ++row.length_errors;
  if (!row.odd_length) {
    tell(EventKind::pdo_length, row, stamped.when, stamped.frame.length);
    row.odd_length = true;
  }
  return stamped.frame.length > row.length;
}

bool PdoInputs::receive(const StampedFrame& stamped) noexcept {
  const std::uint16_t position = find(stamped.frame.id);
  if (position >= rows_.size()) return false;
  Row& row = rows_[position];
  if (stamped.frame.rtr || receptions_[row.node_index] == Reception::off) return true;
  if (check_length(row, stamped)) [[likely]] {
    accept(row, stamped);
  }
  return true;
}

void PdoInputs::accept(Row& row, const StampedFrame& stamped) noexcept {
  unpack(load(stamped.frame), {fields_.data() + row.first, row.count}, image_.values.data());
  ++row.received;
  row.last_time = stamped.when;
  // A frame from before this SYNC answers the one before.
  const std::uint64_t of_beat = beat_ - (stamped.when < sync_ ? 1 : 0);
  row.last_beat = of_beat;
  if (row.every != 0) {
    row.known = receptions_[row.node_index] == Reception::full;
    // Without a phase of its own a frame may come one round later.
    row.due = of_beat + (row.known ? 1U : 2U) * std::uint64_t{row.every};
    if (row.waited && of_beat == beat_) {
      row.waited = false;
      --outstanding_;
      last_arrival_ = stamped.when;
    }
  }
  if (row.misses != 0) {
    row.misses = 0;
    tell(EventKind::pdo_back, row, stamped.when);
  }
  if (row.stale) mark(row, false);
}

void PdoInputs::miss(Row& row, Time now) noexcept {
  ++row.missing;
  if (row.misses == 0) tell(EventKind::pdo_missing, row, now);
  if (row.misses < 255) ++row.misses;
  if (!row.stale) mark(row, true);
}

std::uint32_t PdoInputs::close(Time now) noexcept {
  std::uint32_t missed = 0;
  for (Row& row : rows_) {
    if (row.due == beat_) [[unlikely]] {
      row.due += row.every;
      row.waited = false;
      miss(row, now);
      ++missed;
    }
    if (row.deadline > Time{0} && row.every == 0 && row.misses == 0 &&
        receptions_[row.node_index] != Reception::off && now - row.last_time > row.deadline) {
      miss(row, now);
    }
  }
  outstanding_ = 0;
  return missed;
}

PdoStatus PdoInputs::status(std::size_t position) const noexcept {
  const Row& row = rows_[position];
  return {.received = row.received,
          .missing = row.missing,
          .length_errors = row.length_errors,
          .age = static_cast<std::uint32_t>(beat_ - row.last_beat),
          .stale = row.stale};
}

}  // namespace takt
