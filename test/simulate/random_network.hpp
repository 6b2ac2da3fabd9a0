#pragma once
#include "eds_parser/network_file/load_network.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// Makes a network with drives, inputs and outputs on a bus that is between half full and full. The
/// traffic may even not fit the bus.
LoadedNetwork random_network(sim::Random& random);

}  // namespace takt
