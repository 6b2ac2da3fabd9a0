#pragma once
#include <string>
#include <vector>

namespace takt::logging {

struct FileLogOptions {
  std::string file{};  ///< path of a recording of candump or of the black box
  /// Path of the network file; empty: that of the black box, or no network file.
  std::string network{};
  std::string interface{};  ///< interface in the recording; empty: that of the first frame
  std::vector<std::string> patterns{};  ///< patterns of signals; empty means all
  std::string output{};
};

/// Converts a recording. Throws a Failure if it can't be read or written, or if a pattern matches
/// no signal.
void log_file(const FileLogOptions& options);

}  // namespace takt::logging
