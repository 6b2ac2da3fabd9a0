#pragma once
#include <functional>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace takt::test {

/// A program in a terminal of its own, 140 columns by 20 rows. Killed when the test ends.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void press(const std::string& keys) const;
  /// Reads until `text` was shown since the last call; `meanwhile` again and again. False: never.
  bool shows(const std::string& text, const std::function<void()>& meanwhile = {});
  /// What was read in the last call of shows().
  const std::string& shown() const noexcept { return shown_; }
  /// Exit code when the program ends by itself within a generous time.
  std::optional<int> wait();
  /// The terminal takes whole lines and echoes them, as before the program.
  bool is_as_before() const;

 private:
  void read();

  std::string shown_;
  int fd_ = -1;
  pid_t pid_ = -1;
};

}  // namespace takt::test
