#pragma once
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "master/linux/file_descriptor.hpp"

namespace takt {

/// A program that this one has started. Its stdout and stderr arrive here as lines, and its stdin
/// is empty. It is not in the process group of the terminal, so that Ctrl-C does not reach it. It
/// gets SIGTERM when this program dies.
class ChildProgram {
 public:
  /// Starts `command`, whose first word is the path of the program. The variables of the
  /// environment that `without` names are not passed on. The error is a sentence.
  static std::expected<ChildProgram, std::string> start(const std::vector<std::string>& command,
                                                        const std::vector<std::string>& without);
  ChildProgram(ChildProgram&& other) noexcept;
  ChildProgram& operator=(ChildProgram&&) = delete;
  /// Sends SIGTERM to the program if it still runs, and waits for its end.
  ~ChildProgram();

  /// Returns a descriptor that becomes readable when there is output, and at the end of the output.
  /// Returns -1 after the end.
  int output() const noexcept { return output_.get(); }
  /// Reads the output that has come, without waiting, and calls `line` for each line that is
  /// complete. A line of more than 8192 bytes is passed on in parts.
  void read(const std::function<void(std::string_view)>& line);
  void ask_to_end() const noexcept;  ///< sends SIGTERM
  /// Waits for the end. Returns the exit code, or 128 and the number of the signal that ended it.
  int wait() noexcept;

 private:
  ChildProgram(pid_t process, FileDescriptor output) noexcept;

  pid_t process_;
  FileDescriptor output_;
  std::string begun_;  // begin of a line that is not complete
  int exit_code_ = 0;
};

}  // namespace takt
