#include "apps/takt/log/frame_rows.hpp"

#include <algorithm>
#include <chrono>
#include <span>

#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/raw_number.hpp"

namespace takt::logging {

FrameRows::FrameRows(const BusPlan& plan, const std::vector<LoggedSignal>& signals)
    : sync_{plan.cycle.sync_cob_id},
      has_sync_{plan.cycle.sync},
      period_us_{std::max<std::int64_t>(1, plan.cycle.period / std::chrono::microseconds{1})},
      coming_{std::vector<std::int64_t>(signals.size()), std::vector<std::uint8_t>(signals.size())},
      ended_{coming_} {
  const auto add = [&](const PdoRow& row) {
    if (row.multiplexed()) return;
    for (const PdoField& field : plan.pdos.fields_of(row)) {
      const auto found =
          std::ranges::find(signals, std::size_t{field.signal}, &LoggedSignal::position);
      if (found == signals.end()) continue;
      fields_[row.cob_id].push_back({field, static_cast<std::size_t>(found - signals.begin())});
    }
  };
  for (const PdoRow& row : plan.pdos.tpdos) add(row);
  for (const PdoRow& row : plan.pdos.rpdos) add(row);
}

bool FrameRows::begins_cycle(const Frame& frame, std::int64_t us) const {
  if (has_sync_) return frame.id == sync_ && !frame.rtr;
  return cycle_ < 0 || us - begin_us_ >= period_us_;
}

std::optional<LogRow> FrameRows::take(const Frame& frame, std::int64_t us) {
  std::optional<LogRow> row;
  if (begins_cycle(frame, us)) {
    row = end_cycle();
    const std::int64_t periods =
        cycle_ < 0 ? 1 : std::max<std::int64_t>(1, (us - begin_us_ + period_us_ / 2) / period_us_);
    lost_ = has_sync_ ? periods - 1 : 0;
    cycle_ += periods;
    begin_us_ = us;
  }
  if (cycle_ >= 0 && !frame.rtr) keep(frame);
  return row;
}

void FrameRows::keep(const Frame& frame) {
  const auto found = fields_.find(frame.id);
  if (found == fields_.end()) return;
  const std::uint64_t word = from_little_endian(std::as_bytes(frame.payload()));
  for (const Field& field : found->second) {
    const unsigned offset = field.place.bit_offset;
    const unsigned bits = field.place.bits;
    if (offset + bits > frame.length * 8U) continue;
    const std::uint64_t value =
        (word >> offset) & (bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1);
    coming_.raw[field.column] =
        field.place.sign_extend ? sign_extended(value, bits) : static_cast<std::int64_t>(value);
    coming_.fresh[field.column] = 1;
  }
}

std::optional<LogRow> FrameRows::end_cycle() {
  if (cycle_ < 0) return {};
  std::swap(coming_, ended_);
  std::ranges::fill(coming_.fresh, std::uint8_t{0});
  return LogRow{.utime = begin_us_,
                .sync_ns = begin_us_ * 1000,
                .cycle = cycle_,
                .lost = lost_,
                .raw = ended_.raw,
                .fresh = ended_.fresh};
}

std::optional<LogRow> FrameRows::finish() {
  auto row = end_cycle();
  cycle_ = -1;
  return row;
}

}  // namespace takt::logging
