#pragma once
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace takt::test {

/// A program of the project with its output in a file. Killed when the test ends.
class Process {
 public:
  /// `arguments` begin with the program; stdout and stderr go to `output`.
  Process(std::vector<std::string> arguments, std::filesystem::path output);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  /// Stops it, and returns when none of its threads runs any more. False: it has ended.
  bool stop() const;
  /// Exit code within a generous time, `meanwhile` again and again; none: it still runs, or a
  /// signal ended it.
  std::optional<int> wait(const std::function<void()>& meanwhile = {});
  std::string output() const;  ///< so far
  /// Waits for this text in the output. False: it never came.
  bool says(const std::string& text) const;

 private:
  std::filesystem::path output_;
  pid_t pid_ = -1;
};

/// Runs a program to its end.
struct Ended {
  std::optional<int> exit_code;
  std::string output;
};
Ended run(std::vector<std::string> arguments, const std::filesystem::path& folder);

std::string read_file(const std::filesystem::path& path);

}  // namespace takt::test
