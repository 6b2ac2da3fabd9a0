#pragma once
#include <string>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/bridge.hpp"
#include "master/master_run.hpp"

namespace takt {

/// Returns the text that `taktd --check` prints: nodes, PDOs, signals and boot steps of the plan.
std::string plan_summary(const LoadedNetwork& network);

/// Returns the summary that taktd writes at its end: cycles, times, frames, images, commands and
/// events.
std::string run_summary(const MasterRun& master, const Bridge& bridge, std::uint64_t errors,
                        std::uint64_t warnings);

}  // namespace takt
