#pragma once
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/faults.hpp"
#include "master/sim/random.hpp"

namespace takt::soak {

/// Returns a random sequence of bus faults: calm and stormy times, single faults, and combined ones
/// (a device exchanged for another, a reset in the middle of a boot, EMCY storms). All faults end
/// by `until`. The pauses between them are `slowness` times as long.
sim::Faults fault_walk(const BusPlan& plan, sim::Random random, Time from, Time until,
                       int slowness = 1);

}  // namespace takt::soak
