#pragma once
#include "eds_parser/network_file/load_network.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// Drives and inputs and outputs, on a bus between half full and full. It may not fit at all.
LoadedNetwork random_network(sim::Random& random);

}  // namespace takt
