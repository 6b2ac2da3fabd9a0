#pragma once
#include <filesystem>
#include <string>

#include "apps/taktd/options.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// Neither the network file nor the command line names a bus: the daemon has none to run on.
bool lacks_bus(const DaemonOptions& options, const LoadedNetwork& network);

/// The bus to run on: of the command line, else of the network file; "sim": a simulated one. A bus
/// to which the file gives no name is named after it.
std::string choose_bus(const DaemonOptions& options, LoadedNetwork& network);

/// The file with the keys of LCM, relative to the network file; empty: there are no keys.
std::filesystem::path key_file(const DaemonOptions& options, const LoadedNetwork& network);

}  // namespace takt
