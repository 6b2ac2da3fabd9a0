#pragma once
#include <cstdint>

#include "apps/takt/simulate/simulation.hpp"
#include "apps/takt/simulate/wire_statistics.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {

/// Additional time that the ordered stop of a simulated master may take beyond the plan's limit.
inline constexpr Time stop_slack = std::chrono::seconds{1};

/// Collects the outcome of a run during the run.
class OutcomeLedger {
 public:
  OutcomeLedger(const BusPlan& plan, const WireStatistics& wire, std::uint64_t seed);

  void announce(const Event& event);
  /// Keeps the worst TPDO times. Call this before the stop, because its NMT commands delay the last
  /// TPDOs.
  void keep_worst_tpdos();
  /// From this call on, EMCYs count as sent after the end of the master.
  void mark_end_of_master() noexcept { emcy_before_ = wire_.emcy_frames(); }
  /// Call this once, at the end of the run. `stopped` is true if the ordered stop was completed.
  SimulationOutcome finish(sim::World& world, const StatusSnapshot& snapshot, bool stopped);

 private:
  void count_pdos(const StatusSnapshot& snapshot);

  const BusPlan& plan_;
  const WireStatistics& wire_;
  SimulationOutcome outcome_;
  std::uint64_t emcy_before_ = 0;
};

}  // namespace takt
