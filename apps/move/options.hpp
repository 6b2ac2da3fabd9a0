#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/move/jerk_limited.hpp"

namespace takt {

/// What the user of takt-move asked for. Lengths in the unit of each axis, times in seconds.
struct MoveOptions {
  std::string bus;
  std::string lcm_url;
  std::string keys;           ///< key file; empty: no envelopes
  bool check_images = false;  ///< only what the daemon has signed is believed
  std::vector<double> to;     ///< one an axis, or one for all; empty: a default distance from here
  bool point = true;
  bool sine = true;
  double seconds = 10.0;  ///< of the point-to-point move and the sine together
  std::optional<double> amplitude;
  double frequency = 0.5;
  std::optional<double> velocity;
  std::optional<double> acceleration;
  std::optional<double> jerk;
  std::optional<double> following_limit;
  int stale_cycles = 5;
  double wait_seconds = 10.0;  ///< for the daemon and for its devices
};

/// From the command line. A value is the exit code where there is nothing to run.
struct ParsedMove {
  MoveOptions options;
  std::optional<int> exit_code;
};
ParsedMove parse_move(int argc, char** argv);

}  // namespace takt
