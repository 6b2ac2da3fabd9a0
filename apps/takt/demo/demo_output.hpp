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
  /// Prints a line with the positions of the axes, which comes several times a second. On a
  /// terminal, each line replaces the one before. Elsewhere, one line a second is printed.
  void positions(std::string_view program, std::string_view text);

 private:
  void print(std::string_view text);

  bool terminal_;
  bool replaceable_ = false;  // the last line of the terminal shows positions
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace takt
