#include "master/core/pdo/pdo_inputs.hpp"

#include <algorithm>
#include <utility>

namespace takt {

PdoInputs::PdoInputs(const BusPlan& plan, WorkingImage& image, EventQueue& events)
    : plan_{plan},
      image_{image},
      events_{events},
      marks_(plan.pdos.tpdos.size()),
      receptions_(plan.nodes.size()),
      window_{plan.cycle.sync_window > Time{} ? plan.cycle.sync_window
                                              : plan.cycle.receive_window} {
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
    row.multiplexed = pdo.siblings != 0;
    const bool first_of_id = !pdo.multiplexed() || pdo.siblings != 0;
    if (pdo.cob_id.is_extended() && first_of_id) {
      extended_.push_back(static_cast<std::uint16_t>(rows_.size()));
    }
    rows_.push_back(row);
    mark(rows_.back(), true);
  }
  std::ranges::sort(extended_, {}, [&](std::uint16_t row) { return plan.pdos.tpdos[row].cob_id; });
}

void PdoInputs::mark(Row& row, bool stale) noexcept {
  row.stale = stale;
  for (std::uint16_t i = 0; i < row.count; ++i) {
    image_.set_stale(fields_[row.first + i].signal, stale);
  }
}

void PdoInputs::announce(EventKind kind, const Row& row, Time now, std::uint32_t detail) noexcept {
  events_.push({.when = now,
                .cycle = cycle_,
                .kind = kind,
                .node = plan_.nodes[row.node_index].id.value(),
                .detail = detail,
                .value = row.number});
}

void PdoInputs::change_reception(std::size_t node_index, Reception reception) noexcept {
  const Reception before = std::exchange(receptions_[node_index], reception);
  const bool taken = before != Reception::off && reception != Reception::off;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (row.node_index != node_index) continue;
    if (!taken) {
      mark(row, true);
      row.expires = never;
    }
    row.reception = reception;
    row.known = false;
    row.misses = 0;
    row.waited = false;
    row.was_late = false;
    // The first frame of a TPDO of type n may come up to n beats later, so the margin is 2 n beats.
    // With a SYNC start value, the frame also waits until the counter reaches this value, so the
    // overflow value of the counter is added.
    const bool watched = reception >= Reception::listening && row.every != 0;
    const std::uint64_t counted =
        plan_.pdos.tpdos[i].sync_start == 0 ? 0 : plan_.cycle.sync_overflow;
    row.due = watched ? beat_ + counted + 2 * std::uint64_t{row.every} : not_due;
    // Without full reception, the master does not know which SYNC a frame answers.
    const bool windowed = reception == Reception::full && plan_.cycle.sync &&
                          plan_.pdos.tpdos[i].synchronous() && window_ > Time{};
    row.window = windowed ? window_ : never;
  }
}

void PdoInputs::begin(std::uint64_t cycle, Time sync, bool heard) noexcept {
  cycle_ = cycle;
  expected_ = 0;
  outstanding_ = 0;
  if (!heard) return;
  sync_before_ = sync_;
  sync_ = sync;
  last_arrival_ = sync;
  ++beat_;
  for (Row& row : rows_) {
    row.waited = row.due == beat_ && row.known && row.misses < waited_misses;
    expected_ += row.waited;
  }
  outstanding_ = expected_;
}

std::uint16_t PdoInputs::find_extended(CobId id) const noexcept {
  const auto cob_id = [&](std::uint16_t row) { return plan_.pdos.tpdos[row].cob_id; };
  const auto found = std::ranges::lower_bound(extended_, id, {}, cob_id);
  return found != extended_.end() && cob_id(*found) == id ? *found : no_row;
}

/// Returns the row of the object that an MPDO carries. The header in the lower half of the frame
/// identifies it. A DAM frame to node 0 addresses all nodes, including the master.
std::uint16_t PdoInputs::find_object(std::uint16_t first, const Frame& frame) const noexcept {
  constexpr std::uint32_t to_all = 0x80;
  auto header = static_cast<std::uint32_t>(load(frame));
  if (frame.length < 4) return no_row;
  if ((header & 0xFF) == to_all) header |= plan_.master_id.value();
  const PdoRow* const begin = plan_.pdos.tpdos.data() + first;
  const PdoRow* const end = begin + begin->siblings;
  const PdoRow* const found =
      std::lower_bound(begin, end, header,
                       [](const PdoRow& row, std::uint32_t value) { return row.header < value; });
  if (found == end || found->header != header) return no_row;
  return static_cast<std::uint16_t>(first + (found - begin));
}

std::uint16_t PdoInputs::row_of(const Frame& frame) const noexcept {
  const std::uint16_t position =
      frame.id.is_extended() ? find_extended(frame.id) : plan_.pdos.route[frame.id.id() & 0x7FF];
  if (position >= rows_.size()) return no_row;
  return rows_[position].multiplexed ? find_object(position, frame) : position;
}

/// Counts a frame of wrong length, and reports it once until a frame of the right
/// length comes. Returns true if the frame can be used. A frame that is too short is ignored
/// completely; of a frame that is too long, the first bytes are used.
bool PdoInputs::use_odd_length(std::size_t position, const StampedFrame& stamped) noexcept {
  Row& row = rows_[position];
  const bool longer = stamped.frame.length > row.length;
  ++row.length_errors;
  row.too_long += longer;
  marks_[position].flags |= longer ? PdoMark::too_long : PdoMark::too_short;
  if (!row.odd_length) {
    announce(EventKind::pdo_length, row, stamped.when, stamped.frame.length);
    row.odd_length = true;
  }
  return longer;
}

/// Counts a synchronous frame that has come after its window. The first such frame is
/// reported, unless the TPDO already counts as missing. Returns false if the frame must not be
/// used.
bool PdoInputs::use_late(std::size_t position, const StampedFrame& stamped) noexcept {
  Row& row = rows_[position];
  ++row.late;
  marks_[position].flags |= PdoMark::late;
  if (!row.was_late && row.misses == 0) {
    const Time after = stamped.when - (stamped.when < sync_ ? sync_before_ : sync_);
    announce(EventKind::pdo_late, row, stamped.when,
             static_cast<std::uint32_t>(std::min<Time::rep>(after.count() / 1000, 0xFFFF'FFFF)));
  }
  row.was_late = true;
  return !plan_.pdos.tpdos[position].drop_late;
}

[[gnu::always_inline]] inline void PdoInputs::accept(Row& row, PdoMark& mark,
                                                     const StampedFrame& stamped) noexcept {
  unpack(load(stamped.frame), {fields_.data() + row.first, row.count}, image_.values.data());
  // A frame that has arrived before this SYNC belongs to the previous SYNC.
  const unsigned before = stamped.when < sync_ ? 1 : 0;
  ++mark.received;
  mark.cycle = static_cast<std::uint32_t>(cycle_) - before;
  mark.flags |= PdoMark::arrived;
  const std::uint64_t of_beat = beat_ - before;
  row.last_beat = of_beat;
  if (row.deadline > Time{}) row.expires = stamped.when + row.deadline;
  if (row.every != 0) {
    row.known = row.reception == Reception::full;
    // As long as the phase of the TPDO is unknown, its next frame may come n beats later than
    // expected.
    row.due = of_beat + (row.known ? 1U : 2U) * std::uint64_t{row.every};
    if (row.waited && before == 0) {
      row.waited = false;
      --outstanding_;
      last_arrival_ = stamped.when;
    } else if (before != 0 && row.known && row.due == beat_ && !row.waited) [[unlikely]] {
      // This frame has shown the phase of the TPDO, whose next frame is due in this beat. So the
      // beat waits for that frame, too.
      row.waited = true;
      ++expected_;
      ++outstanding_;
    }
  }
  if (row.stale || row.misses != 0) [[unlikely]] {
    come_back(row, stamped.when);
  }
}

bool PdoInputs::receive(const StampedFrame& stamped) noexcept {
  const Frame& frame = stamped.frame;
  std::size_t position =
      frame.id.is_extended() ? find_extended(frame.id) : plan_.pdos.route[frame.id.id() & 0x7FF];
  if (position >= rows_.size()) return false;
  if (frame.rtr || rows_[position].reception == Reception::off) return true;
  if (rows_[position].multiplexed) [[unlikely]] {
    position = find_object(static_cast<std::uint16_t>(position), frame);
    if (position == no_row) return true;
  }
  Row& row = rows_[position];
  if (frame.length != row.length) [[unlikely]] {
    if (!use_odd_length(position, stamped)) return true;
  } else {
    row.odd_length = false;
  }
  if (stamped.when - (stamped.when >= sync_ ? sync_ : sync_before_) > row.window) [[unlikely]] {
    if (!use_late(position, stamped)) return true;
  } else {
    row.was_late = false;
  }
  accept(row, marks_[position], stamped);
  return true;
}

void PdoInputs::come_back(Row& row, Time when) noexcept {
  if (row.misses != 0) {
    row.misses = 0;
    announce(EventKind::pdo_back, row, when);
  }
  if (row.stale) mark(row, false);
}

void PdoInputs::miss(std::size_t position, Time now) noexcept {
  Row& row = rows_[position];
  ++row.missing;
  marks_[position].flags |= PdoMark::missing;
  if (row.misses == 0) announce(EventKind::pdo_missing, row, now);
  if (row.misses < 255) ++row.misses;
  if (!row.stale) mark(row, true);
}

std::uint32_t PdoInputs::close(Time now) noexcept {
  std::uint32_t missed = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (row.due == beat_) [[unlikely]] {
      row.due += row.every;
      row.waited = false;
      miss(i, now);
      ++missed;
    }
    if (now > row.expires) [[unlikely]] {
      row.expires = never;
      if (row.misses == 0) miss(i, now);
    }
  }
  outstanding_ = 0;
  return missed;
}

PdoStatus PdoInputs::status(std::size_t position) const noexcept {
  const Row& row = rows_[position];
  return {.received = marks_[position].received,
          .missing = row.missing,
          .late = row.late,
          .length_errors = row.length_errors,
          .too_long = row.too_long,
          .age = static_cast<std::uint32_t>(beat_ - row.last_beat),
          .stale = row.stale};
}

}  // namespace takt
