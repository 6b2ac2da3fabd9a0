#pragma once
#include <filesystem>
#include <string>

#include "apps/taktd/daemon_options.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// Returns true if neither the network file nor the command line names a bus to run on.
bool lacks_bus(const DaemonOptions& options, const LoadedNetwork& network);

/// Returns the bus to run on: the one from the command line, otherwise the one from the network
/// file. "sim" means a simulated bus. Writes the choice into the plan; if the network file gives
/// the bus no name, a bus from the command line is named after its interface.
std::string choose_bus(const DaemonOptions& options, LoadedNetwork& network);

/// Returns the path of the LCM key file, which the network file gives relative to its own folder.
/// The path is empty if the network file names no keys.
std::filesystem::path key_file(const DaemonOptions& options, const LoadedNetwork& network);

}  // namespace takt
