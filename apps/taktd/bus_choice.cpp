#include "apps/taktd/bus_choice.hpp"

#include "master/linux/bus_name.hpp"

namespace takt {

bool lacks_bus(const DaemonOptions& options, const LoadedNetwork& network) {
  return !options.bus && network.plan.interface.empty();
}

std::string choose_bus(const DaemonOptions& options, LoadedNetwork& network) {
  BusPlan& plan = network.plan;
  if (options.bus) {
    const bool simulated = BusName::parse(*options.bus).kind == BusName::Kind::simulated;
    plan.interface = simulated ? "" : *options.bus;
    if (!network.bus_named && !simulated) plan.name = plan.interface;
  }
  return plan.interface.empty() ? "sim" : plan.interface;
}

std::filesystem::path key_file(const DaemonOptions& options, const LoadedNetwork& network) {
  if (network.lcm.keys.empty()) return {};
  return std::filesystem::path{options.network_file}.parent_path() / network.lcm.keys;
}

}  // namespace takt
