#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/wire_frame.hpp"

namespace takt {

/// How evenly SYNC lay on the wire.
struct SyncOnWire {
  std::uint64_t count = 0;
  std::uint64_t gaps = 0;  ///< distances of 1.5 periods and more
  Time shortest = Time::max();
  Time longest{};
  /// Distance of two SYNCs against the period, without the gaps; a bucket is a microsecond.
  std::vector<std::uint64_t> deviation = std::vector<std::uint64_t>(10'001);

  /// The deviation that so many parts of 1 stay below.
  Time quantile(double part) const;
};

/// One PDO as it was on the wire.
struct PdoOnWire {
  std::uint64_t frames = 0;
  std::uint64_t late = 0;  ///< TPDO: ended after the receive window
  Time worst{};            ///< TPDO: longest time from the start of SYNC to its end
};

/// What was on the wire, counted frame by frame.
class WireStatistics final : public sim::BusObserver {
 public:
  explicit WireStatistics(const BusPlan& plan);

  void on_wire(const sim::WireFrame& wire) noexcept override;

  const SyncOnWire& sync() const noexcept { return sync_; }
  const PdoOnWire& tpdo(std::size_t row) const noexcept { return tpdos_[row]; }
  const PdoOnWire& rpdo(std::size_t row) const noexcept { return rpdos_[row]; }
  /// The fullest of the cycles between two SYNCs, in bits; without SYNC 0.
  std::uint64_t worst_cycle_bits() const noexcept { return worst_bits_; }
  std::uint64_t sdo_frames() const noexcept { return sdo_frames_; }
  std::uint64_t emcy_frames() const noexcept { return emcy_frames_; }

 private:
  void on_sync(Time start) noexcept;
  void on_tpdo(PdoOnWire& pdo, const PdoRow& row, Time end) noexcept;
  void count_service(CobId id) noexcept;

  const BusPlan& plan_;
  SyncOnWire sync_;
  std::vector<PdoOnWire> tpdos_;
  std::vector<PdoOnWire> rpdos_;
  std::map<CobId, std::uint16_t> tpdo_rows_;
  std::map<CobId, std::uint16_t> rpdo_rows_;
  Time last_sync_{};
  std::uint64_t cycle_bits_ = 0;
  std::uint64_t worst_bits_ = 0;
  std::uint64_t sdo_frames_ = 0;
  std::uint64_t emcy_frames_ = 0;
};

}  // namespace takt
