#pragma once
#include "apps/soak/soak_run.hpp"

namespace takt {

/// A whole taktd, front thread included, with several programs in virtual time, and everything that
/// can happen to them. The same seed gives the same run.
SoakOutcome soak_front(const LoadedNetwork& network, const SoakOptions& options);

}  // namespace takt
