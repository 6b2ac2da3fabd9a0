#pragma once
#include <optional>
#include <string>
#include <takt/motion.hpp>
#include <vector>

#include "apps/axis/axes_program.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Options of takt-home.
struct HomeOptions {
  AxesProgram program{.name = "takt-home"};
  HomingOptions homing;
  bool reset = false;  ///< resets the faults of the axes first
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedHome {
  HomeOptions options;
  std::optional<int> exit_code;
};
ParsedHome parse_home(int argc, char** argv);

}  // namespace takt
