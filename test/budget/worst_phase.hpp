#pragma once
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct PhaseOptions {
  Time device_time{};
  unsigned cycles = 100;
  bool emcys = false;  ///< each node sends one EMCY, all at once
  /// True: the service frames of the master wait in the queue of SYNC and the outputs, as with
  /// SocketCAN. False: they have a separate queue.
  bool one_queue = false;
  Time error_distance{};  ///< shortest distance of two destroyed frames; 0 = none is destroyed
};

/// The measured times of one row of the budget.
struct SeenRow {
  std::size_t frames = 0;
  Time worst{};  ///< as BudgetRow::worst: from SYNC, or from the moment of queueing
};

/// The measured times of a bus.
struct SeenBus {
  std::vector<SeenRow> rows;   ///< in the order of the rows of the budget
  std::uint64_t errors = 0;    ///< destroyed frames
  unsigned not_in_budget = 0;  ///< frames of the network that have no row
};

/// Sends the frames of a network on the bit-accurate bus, at the moments with the longest delays.
/// The data have as many stuff bits as possible. Frames that come by themselves come just before
/// SYNC, the TPDOs and the outputs. The plan decides which frames are sent and how often; only the
/// number of SDO dialogues is that of the budget.
SeenBus run_worst_phase(const BusPlan& plan, const BusBudget& budget, const PhaseOptions& options,
                        sim::Random random);

}  // namespace takt
