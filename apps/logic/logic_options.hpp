#pragma once
#include <optional>
#include <string>

#include "apps/axis/axes_program.hpp"

namespace takt {

/// Options of takt-logic.
struct LogicOptions {
  AxesProgram program{.name = "takt-logic"};
  std::string file;    ///< path of the file with the rules
  bool check = false;  ///< print the rules, without a bus
  bool quiet = false;  ///< do not print each change
  std::optional<std::chrono::nanoseconds> seconds;
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedLogic {
  LogicOptions options;
  std::optional<int> exit_code;
};
ParsedLogic parse_logic(int argc, char** argv);

}  // namespace takt
