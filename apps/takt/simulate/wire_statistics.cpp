#include "apps/takt/simulate/wire_statistics.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

constexpr std::uint32_t interframe_bits = 3;

}  // namespace

Time SyncOnWire::quantile(double part) const {
  std::uint64_t all = 0;
  for (const std::uint64_t bucket : deviation) all += bucket;
  auto left = static_cast<std::uint64_t>(static_cast<double>(all) * part);
  for (std::size_t us = 0; us < deviation.size(); ++us) {
    if (deviation[us] > left) return std::chrono::microseconds{us};
    left -= deviation[us];
  }
  return std::chrono::microseconds{all == 0 ? 0 : deviation.size() - 1};
}

WireStatistics::WireStatistics(const BusPlan& plan)
    : plan_{plan}, tpdos_(plan.pdos.tpdos.size()), rpdos_(plan.pdos.rpdos.size()) {
  list(Content::Kind::tpdo, plan.pdos.tpdos);
  list(Content::Kind::rpdo, plan.pdos.rpdos);
  content(plan.cycle.sync_cob_id) = {.kind = Content::Kind::sync};
}

/// If several PDOs have the same identifier, all frames count for the first of them.
void WireStatistics::list(Content::Kind kind, const std::vector<PdoRow>& pdos) {
  for (std::size_t row = 0; row < pdos.size(); ++row) {
    Content& carried = content(pdos[row].cob_id);
    if (carried.kind == Content::Kind::service) {
      carried = {.kind = kind, .row = static_cast<std::uint16_t>(row)};
    }
  }
}

WireStatistics::Content WireStatistics::extended_content(CobId id) const noexcept {
  const auto found = extended_ids_.find(id);
  return found == extended_ids_.end() ? Content{} : found->second;
}

void WireStatistics::on_wire(const sim::WireFrame& wire) noexcept {
  cycle_bits_ += wire.bits + interframe_bits;
  if (wire.result != sim::WireResult::sent || wire.frame.rtr) return;
  const CobId id = wire.frame.id;
  const Content carried = content_of(id);
  switch (carried.kind) {
    case Content::Kind::sync:
      return on_sync(wire.start);
    case Content::Kind::tpdo:
      return on_tpdo(tpdos_[carried.row], plan_.pdos.tpdos[carried.row], wire.end);
    case Content::Kind::rpdo:
      ++rpdos_[carried.row].frames;
      return;
    case Content::Kind::service:
      if (!id.is_extended()) count_service(id);
      return;
  }
}

void WireStatistics::count_service(CobId id) noexcept {
  const std::uint32_t function = id.id() & 0x780;
  sdo_frames_ += function == 0x580 || function == 0x600;
  emcy_frames_ += function == 0x080;
}

void WireStatistics::on_sync(Time start) noexcept {
  const std::uint64_t bits = std::exchange(cycle_bits_, 0);
  if (sync_.count++ != 0) {
    const Time distance = start - last_sync_;
    sync_.shortest = std::min(sync_.shortest, distance);
    sync_.longest = std::max(sync_.longest, distance);
    if (2 * distance >= 3 * plan_.cycle.period) {
      ++sync_.gaps;
    } else {
      worst_bits_ = std::max(worst_bits_, bits);
      const auto us = std::chrono::round<std::chrono::microseconds>(
          distance > plan_.cycle.period ? distance - plan_.cycle.period
                                        : plan_.cycle.period - distance);
      const auto bucket = static_cast<std::size_t>(us.count());
      ++sync_.deviation[std::min(bucket, sync_.deviation.size() - 1)];
    }
  }
  last_sync_ = start;
}

void WireStatistics::on_tpdo(PdoOnWire& pdo, const PdoRow& row, Time end) noexcept {
  ++pdo.frames;
  if (!row.cyclic() || sync_.count == 0) return;
  const Time after = end - last_sync_;
  pdo.worst = std::max(pdo.worst, after);
  pdo.late += after > plan_.cycle.receive_window;
}

}  // namespace takt
