#pragma once
#include <string>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/bridge.hpp"
#include "master/master.hpp"

namespace takt {

/// What `taktd --check` prints: the size of what would run.
std::string plan_summary(const LoadedNetwork& network);

/// What taktd says at its end: cycles, lateness, frames, nodes.
std::string run_summary(const Master& master, const Bridge& bridge, std::uint64_t errors,
                        std::uint64_t warnings);

}  // namespace takt
