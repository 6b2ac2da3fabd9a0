#pragma once
#include <cstdint>

#include "apps/simulate/simulation.hpp"
#include "apps/simulate/wire_statistics.hpp"
#include "master/rt/status_board.hpp"
#include "master/sim/world.hpp"

namespace takt {

/// The ordered stop of a simulated master may take so much longer than the plan says.
inline constexpr Time stop_slack = std::chrono::seconds{1};

/// Writes the outcome of a run while it goes on.
class OutcomeLedger {
 public:
  OutcomeLedger(const BusPlan& plan, const WireStatistics& wire, std::uint64_t seed);

  void tell(const Event& event);
  /// Before the stop, whose NMT commands delay the last TPDOs.
  void keep_worst_tpdos();
  /// EMCYs that come from now on come when the master has ended.
  void mark_end_of_master() noexcept { emcy_before_ = wire_.emcy_frames(); }
  /// The run is over. `stopped`: the ordered stop came to its end.
  SimulationOutcome finish(sim::World& world, const StatusSnapshot& snapshot, bool stopped);

 private:
  void count_pdos(const StatusSnapshot& snapshot);

  const BusPlan& plan_;
  const WireStatistics& wire_;
  SimulationOutcome outcome_;
  std::uint64_t emcy_before_ = 0;
};

}  // namespace takt
