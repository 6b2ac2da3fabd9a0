#pragma once
#include "apps/takt/soak/soak_run.hpp"

namespace takt::soak {

/// Runs a whole taktd, including its front thread, and several programs in virtual time, with
/// random faults of all of them. The same seed gives the same run.
SoakOutcome soak_front(const LoadedNetwork& network, const SoakOptions& options);

}  // namespace takt::soak
