#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/wire_frame.hpp"

namespace takt {

/// The regularity of the SYNC period on the wire.
struct SyncOnWire {
  std::uint64_t count = 0;
  std::uint64_t gaps = 0;  ///< distances of at least 1.5 periods
  Time shortest = Time::max();
  Time longest{};
  /// Absolute deviation of the SYNC distance from the period, without the gaps. A bucket is a
  /// microsecond; the last one also holds all greater deviations.
  std::vector<std::uint64_t> deviation = std::vector<std::uint64_t>(10'001);

  /// Returns the quantile of the deviation. `part` is a fraction of 0..1.
  Time quantile(double part) const;
};

/// Counters of one PDO on the wire.
struct PdoOnWire {
  std::uint64_t frames = 0;
  std::uint64_t late = 0;  ///< cyclic TPDO: frames that ended after the receive window
  Time worst{};            ///< cyclic TPDO: longest time from the start of SYNC to the frame's end
};

/// Counts the frames on the wire.
class WireStatistics final : public sim::BusObserver {
 public:
  explicit WireStatistics(const BusPlan& plan);

  void on_wire(const sim::WireFrame& wire) noexcept override;

  const SyncOnWire& sync() const noexcept { return sync_; }
  const PdoOnWire& tpdo(std::size_t row) const noexcept { return tpdos_[row]; }
  const PdoOnWire& rpdo(std::size_t row) const noexcept { return rpdos_[row]; }
  /// Returns the number of bits in the busiest cycle between two SYNCs, without gaps. 0 without
  /// SYNC.
  std::uint64_t worst_cycle_bits() const noexcept { return worst_bits_; }
  std::uint64_t sdo_frames() const noexcept { return sdo_frames_; }
  std::uint64_t emcy_frames() const noexcept { return emcy_frames_; }

 private:
  /// What the frames of one identifier carry.
  struct Content {
    enum class Kind : std::uint8_t { service, sync, tpdo, rpdo } kind = Kind::service;
    std::uint16_t row = 0;
  };

  void list(Content::Kind kind, const std::vector<PdoRow>& pdos);
  Content& content(CobId id) { return id.is_extended() ? extended_ids_[id] : base_ids_[id.id()]; }
  Content content_of(CobId id) const noexcept {
    return id.is_extended() ? extended_content(id) : base_ids_[id.id()];
  }
  Content extended_content(CobId id) const noexcept;
  void on_sync(Time start) noexcept;
  void on_tpdo(PdoOnWire& pdo, const PdoRow& row, Time end) noexcept;
  void count_service(CobId id) noexcept;

  const BusPlan& plan_;
  SyncOnWire sync_;
  std::vector<PdoOnWire> tpdos_;
  std::vector<PdoOnWire> rpdos_;
  std::vector<Content> base_ids_ = std::vector<Content>(0x800);  ///< indexed by 11-bit identifier
  std::map<CobId, Content> extended_ids_;
  Time last_sync_{};
  std::uint64_t cycle_bits_ = 0;
  std::uint64_t worst_bits_ = 0;
  std::uint64_t sdo_frames_ = 0;
  std::uint64_t emcy_frames_ = 0;
};

}  // namespace takt
