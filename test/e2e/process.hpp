#pragma once
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace takt::test {

/// A program of the project whose output goes to a file. The destructor kills it.
class Process {
 public:
  /// `arguments` begin with the program; stdout and stderr go to `output`.
  Process(std::vector<std::string> arguments, std::filesystem::path output);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  /// Stops the process and returns when none of its threads runs any more. Returns false if the
  /// process has ended.
  bool stop() const;
  /// Waits at most `time_limit` for the exit code and calls `meanwhile` repeatedly. Returns
  /// std::nullopt if the process still runs or if a signal ended it.
  std::optional<int> wait(const std::function<void()>& meanwhile = {});
  std::string output() const;  ///< output so far
  /// Waits for this text in the output. Returns false if it does not come within `time_limit`.
  bool says(const std::string& text) const;

 private:
  std::filesystem::path output_;
  pid_t pid_ = -1;
};

/// Exit code and output of a program that has ended.
struct Ended {
  std::optional<int> exit_code;
  std::string output;
};
Ended run(std::vector<std::string> arguments, const std::filesystem::path& folder);

/// Returns true if a program reports that a motion was stopped because the bus thread has missed
/// cycles, as it does on a busy machine.
bool missed_cycles(const std::string& output);

std::string read_file(const std::filesystem::path& path);

}  // namespace takt::test
