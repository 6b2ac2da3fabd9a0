#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/live_arguments.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::logging {

struct LiveLogOptions {
  LiveOptions live{};
  std::vector<std::string> patterns{};  ///< patterns of signals; empty means all
  std::string output{};
  /// Length of the log; empty: until Ctrl-C or the end of the daemon.
  std::optional<Time> length{};
};

/// Records the running bus. Throws a Failure if there is no daemon, if a pattern matches no signal,
/// or if the file can't be written.
void log_live(const LiveLogOptions& options);

}  // namespace takt::logging
