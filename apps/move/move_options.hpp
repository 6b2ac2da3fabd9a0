#pragma once
#include <optional>
#include <string>
#include <vector>

namespace takt {

/// Options of takt-move. Lengths are in the unit of each axis, times in seconds.
struct MoveOptions {
  std::string bus;  ///< empty: the first bus whose layout arrives
  std::string lcm_url;
  std::string keys;           ///< path of the key file; empty means no envelopes
  bool check_images = false;  ///< true: messages of taktd without a valid signature are ignored
  /// Target positions, one for each axis or one for all axes. Empty means a default distance from
  /// the present position.
  std::vector<double> to;
  bool point = true;
  bool sine = true;
  /// Longest duration of the move and the sine together. If empty, the sine follows the move until
  /// 10 s after the start, but for at least one period.
  std::optional<double> seconds;
  std::optional<double> amplitude;
  double frequency = 0.5;
  std::optional<double> velocity;
  std::optional<double> acceleration;
  std::optional<double> jerk;
  std::optional<double> following_limit;
  int stale_cycles = 5;
  std::string plot;            ///< file for a picture of the motions; empty: none
  double wait_seconds = 10.0;  ///< longest wait for taktd, and then for its devices
};

/// Result of reading the command line. If there is an exit code, the program ends with it.
struct ParsedMove {
  MoveOptions options;
  std::optional<int> exit_code;
};
ParsedMove parse_move(int argc, char** argv);

}  // namespace takt
