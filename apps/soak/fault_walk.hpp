#pragma once
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/faults.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// A random walk through everything that can go wrong with a bus: calm and stormy times, single
/// faults and those that come together (a device exchanged for another, a reset in the middle of a
/// boot, EMCY storms). All are over at `until`.
sim::Faults fault_walk(const BusPlan& plan, sim::Random random, Time from, Time until);

}  // namespace takt
