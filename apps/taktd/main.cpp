#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/finding_text.hpp"
#include "apps/taktd/bus_choice.hpp"
#include "apps/taktd/daemon.hpp"
#include "apps/taktd/daemon_options.hpp"
#include "apps/taktd/summary.hpp"
#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/lcm/envelope/key_file.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/rt_thread.hpp"

namespace takt {
namespace {

/// Returns the verdict of `takt budget`. Prints a message if frames can be too late.
bool fits_the_bus(const LoadedNetwork& network, const std::string& file, const char* severity) {
  if (bus_fits(network.plan)) return true;
  std::fprintf(stderr,
               "taktd: %sin the worst case frames are too late on this bus: `takt budget %s` lists "
               "these frames and the cheapest change that makes them fit\n",
               severity, file.c_str());
  return false;
}

/// Returns false and prints the reason if the key file is missing or readable by others. taktd
/// would refuse to start with this file.
bool has_good_keys(const DaemonOptions& options, const LoadedNetwork& network) {
  const auto file = key_file(options, network);
  if (file.empty()) return true;
  const auto keys = load_keys(file);
  if (!keys) std::fprintf(stderr, "taktd: %s\n", printable_text(keys.error()).c_str());
  return keys.has_value();
}

Exit run(const DaemonOptions& options) {
  LoadedNetwork network = load_network(options.network_file);
  if (print_findings(network.findings)) return Exit::wrong_use;
  if (options.check) {
    choose_bus(options, network);
    if (!has_good_keys(options, network)) return Exit::wrong_use;
    if (std::fputs(plan_summary(network).c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
      std::fprintf(stderr, "taktd: can't write to stdout: %s\n", std::strerror(errno));
      return Exit::refused;
    }
    return fits_the_bus(network, options.network_file, "") ? Exit::good : Exit::refused;
  }
  if (lacks_bus(options, network)) {
    std::fprintf(stderr,
                 "taktd: %s names no bus: write `bus: {interface: can0}` into it, or start taktd "
                 "with --bus can0 (--bus sim simulates bus and devices)\n",
                 options.network_file.c_str());
    return Exit::wrong_use;
  }
  fits_the_bus(network, options.network_file, "warning: ");
  std::vector<LoadedNetwork> networks;
  networks.push_back(std::move(network));
  prepare_memory();
  Daemon daemon{std::move(networks), options};
  return daemon.run();
}

}  // namespace
}  // namespace takt

int main(int argc, char** argv) {
  const auto options = takt::read_command_line(argc, argv);
  if (!options) return options.error();
  try {
    return static_cast<int>(takt::run(*options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "taktd: %s\n", error.what());
    return static_cast<int>(takt::Exit::bus_failure);
  }
}
