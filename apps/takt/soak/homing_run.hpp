#pragma once
#include "apps/takt/soak/soak_run.hpp"

namespace takt::soak {

/// Runs a whole taktd and two programs that home their axes and move them with the library of
/// applications, in virtual time. Meanwhile nodes lose their power, reset and have errors, SYNC is
/// missing, programs are killed, and taktd restarts. The same seed gives the same run.
SoakOutcome soak_homing(const LoadedNetwork& network, const SoakOptions& options);

}  // namespace takt::soak
