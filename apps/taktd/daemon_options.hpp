#pragma once
#include <expected>
#include <optional>
#include <string>

#include "eds_parser/table/run_options.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The command line of taktd.
struct DaemonOptions {
  std::string network_file;
  std::optional<std::string> bus;  ///< overrides the interface of the network file
  std::optional<RtMode> rt;        ///< overrides the mode of the network file
  std::string lcm_url;
  std::string events_file;
  std::string gateway;    ///< CiA 309-3 gateway: unix:PATH or tcp:PORT; empty means no gateway
  std::string black_box;  ///< folder for recordings; if empty, the network file decides
  Time run_for{};         ///< 0 means until a signal
  bool check = false;
  bool observe = false;
  bool motions = true;        ///< runs the motions of motion_command_t
  std::optional<bool> typed;  ///< overrides the setting of the network file
};

/// Returns the options. If the command line asks for help or is wrong, prints that and returns the
/// exit code.
std::expected<DaemonOptions, int> read_command_line(int argc, char** argv);

}  // namespace takt
