#pragma once
#include "apps/takt/simulate/simulation.hpp"

namespace takt {

/// Does the same as simulate(), but runs the whole of taktd with its front thread and its gateway,
/// and SimulationOptions::applications programs that move the axes over LCM. Everything runs in
/// virtual time.
SimulationOutcome simulate_front(const LoadedNetwork& network, const SimulationOptions& options);

}  // namespace takt
