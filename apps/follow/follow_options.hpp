#pragma once
#include <optional>
#include <string>

#include "apps/axis/axes_program.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Options of takt-follow. Lengths are in the unit of the axis, times of limits in seconds.
struct FollowOptions {
  AxesProgram program{.name = "takt-follow"};
  std::string leader;  ///< an axis, or the node of `signal`
  std::string signal;  ///< empty: the commanded position of the leader
  double ratio = 1.0;
  std::optional<double> phase;
  double modulo = 0.0;
  Time filter_time{};  ///< 0: the default of taktd
  double max_phase_error = 0.0;
  double velocity = 0.0;  ///< 0: the limit of the network file; also for acceleration and jerk
  double acceleration = 0.0;
  double jerk = 0.0;
  std::optional<Time> seconds;  ///< time for which the axis follows
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedFollow {
  FollowOptions options;
  std::optional<int> exit_code;
};
ParsedFollow parse_follow(int argc, char** argv);

}  // namespace takt
