#pragma once
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct PhaseOptions {
  Time device_time{};
  unsigned cycles = 100;
  bool emcys = false;  ///< one of each node, all at once
  /// The master's other frames wait in the queue of SYNC and outputs, as with SocketCAN; else they
  /// have one of their own.
  bool one_queue = false;
  Time error_distance{};  ///< least of two destroyed frames; 0: none is
};

/// What was seen of one row of the budget.
struct SeenRow {
  std::size_t frames = 0;
  Time worst{};  ///< as BudgetRow::worst: after SYNC, or after being queued
};

/// What was seen of a bus.
struct SeenBus {
  std::vector<SeenRow> rows;   ///< as those of the budget
  std::uint64_t errors = 0;    ///< destroyed frames
  unsigned not_in_budget = 0;  ///< frames of the network that no row speaks of
};

/// Lets the frames of a network run over the bit-accurate bus, at the moments that hurt most: data
/// that stuff most, what comes by itself just before SYNC, the TPDOs and the outputs. What is sent,
/// and how often, is the network's word; of the budget only the number of SDO dialogues is taken.
SeenBus run_worst_phase(const BusPlan& plan, const BusBudget& budget, const PhaseOptions& options,
                        sim::Random random);

}  // namespace takt
