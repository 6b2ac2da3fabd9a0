#pragma once
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct BusKind {
  double by_event = 0.15;  ///< share of the PDOs that are not synchronous
  double followed = 0.15;  ///< share of the buses on which another device makes SYNC
  std::uint32_t least_percent = 30;
  std::uint32_t most_percent = 90;  ///< of the period that the PDOs need with worst stuffing
};

/// Makes a bus with random nodes, PDOs, bit rate and period. Its cycle is the one that takt
/// compiles.
BusPlan random_bus(sim::Random& random, const BusKind& kind = {});

}  // namespace takt
