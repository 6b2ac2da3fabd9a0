#pragma once
#include <optional>
#include <string>
#include <takt/motion.hpp>
#include <vector>

#include "apps/axis/lcm_access.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// Options of takt-home.
struct HomeOptions {
  std::string bus;
  std::vector<std::string> axes;  ///< in the order of their homing; empty: all axes of the bus
  LcmAccess lcm;
  HomingOptions homing;
  bool reset = false;  ///< resets the faults of the axes first
  Time timeout = std::chrono::milliseconds{500};
  Time wait = std::chrono::seconds{10};
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedHome {
  HomeOptions options;
  std::optional<int> exit_code;
};
ParsedHome parse_home(int argc, char** argv);

}  // namespace takt
