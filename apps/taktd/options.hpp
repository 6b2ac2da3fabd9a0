#pragma once
#include <expected>
#include <optional>
#include <string>

#include "eds_parser/table/run_options.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// The command line of taktd.
struct DaemonOptions {
  std::string network_file;
  std::optional<std::string> bus;  ///< else the network file's interface
  std::optional<RtMode> rt;        ///< else the network file's
  std::string lcm_url;
  std::string events_file;
  std::string gateway;    ///< CiA 309-3: unix:PATH, tcp:PORT; empty: none
  std::string black_box;  ///< folder for recordings; empty: none
  Time run_for{};         ///< 0: until a signal
  bool check = false;
  bool observe = false;
  std::optional<bool> typed;  ///< else the network file's
};

/// The options, or the exit code when the command line asks for help or is wrong (told already).
std::expected<DaemonOptions, int> read_command_line(int argc, char** argv);

}  // namespace takt
