#pragma once
#include "apps/simulate/simulation.hpp"

namespace takt {

/// As simulate(), with the whole taktd, its front thread and its gateway included, and
/// SimulationOptions::applications programs that move the axes over LCM. All in virtual time.
SimulationOutcome simulate_front(const LoadedNetwork& network, const SimulationOptions& options);

}  // namespace takt
