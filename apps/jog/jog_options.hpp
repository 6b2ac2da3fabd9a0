#pragma once
#include <optional>
#include <string>

#include "apps/axis/axes_program.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Options of takt-jog. Lengths are in the unit of the axis, times of limits in seconds.
struct JogOptions {
  AxesProgram program{.name = "takt-jog"};
  double velocity = 0.0;
  /// Empty: the axis reaches its velocity in a quarter of a second.
  std::optional<double> acceleration;
  double jerk = 0.0;  ///< 0: the limit of the network file
  Time first = std::chrono::milliseconds{700};
  Time dead_man = std::chrono::milliseconds{250};
  std::optional<Time> seconds;  ///< duration of a jog without a keyboard
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedJog {
  JogOptions options;
  std::optional<int> exit_code;
};
ParsedJog parse_jog(int argc, char** argv);

}  // namespace takt
