#pragma once
#include <string>

#include "apps/taktd/options.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// The bus to run on: of the command line, else of the network file, else "sim". A bus to which the
/// file gives no name is named after it.
std::string choose_bus(const DaemonOptions& options, LoadedNetwork& network);

}  // namespace takt
