#pragma once
#include <chrono>
#include <string>
#include <string_view>

namespace takt {

/// Prints what the programs of the demo say, with the name of the program before each line.
class DemoOutput {
 public:
  DemoOutput();

  /// Prints a text of `takt demo` itself.
  void say(std::string_view text);
  void line(std::string_view program, std::string_view text);
  /// Prints the positions of the axes, which come several times a second: on a terminal the newest
  /// replaces the one before, elsewhere one a second is printed.
  void positions(std::string_view program, std::string_view text);

 private:
  void print(std::string_view text);

  bool terminal_;
  bool replaceable_ = false;  // the last line of the terminal has positions
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace takt
