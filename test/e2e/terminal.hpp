#pragma once
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace takt::test {

/// A program in its own terminal (`xterm`) of 140 columns by 20 rows. The destructor kills it.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void press(const std::string& keys) const;
  void signal(int number) const { ::kill(pid_, number); }
  /// Reads until the program has shown `text` since the last call, and calls `meanwhile`
  /// repeatedly. Returns false if the text does not come within `time_limit`.
  bool shows(const std::string& text, const std::function<void()>& meanwhile = {});
  /// The text that the last call of shows() has read.
  const std::string& shown() const noexcept { return shown_; }
  /// Returns the exit code if the program ends by itself within `time_limit`.
  std::optional<int> wait();
  /// True if the terminal takes whole lines and echoes them, as before the start of the program.
  bool is_as_before() const;

 private:
  void read();

  std::string shown_;
  int fd_ = -1;
  pid_t pid_ = -1;
};

}  // namespace takt::test
