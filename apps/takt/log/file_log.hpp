#pragma once
#include <string>
#include <vector>

namespace takt::logging {

struct FileLogOptions {
  std::string file{};                   ///< recording of candump or of the black box
  std::string network{};                ///< network file; empty: that of the black box, or none
  std::string interface{};              ///< of the recording; empty: that of the first frame
  std::vector<std::string> patterns{};  ///< of signals; empty means all
  std::string output{};
};

/// Converts a recording. Throws a Failure if it can't be read or written, or if a pattern matches
/// no signal.
void log_file(const FileLogOptions& options);

}  // namespace takt::logging
