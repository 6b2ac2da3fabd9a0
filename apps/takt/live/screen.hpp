#pragma once
#include <cstddef>
#include <vector>

#include "apps/takt/live/text/line.hpp"

namespace takt {

/// Returns the columns that stdout has: those of the terminal, else COLUMNS, else 80.
std::size_t output_width();

/// Returns true if stdout is a terminal that can move its cursor: TERM is neither "dumb" nor empty.
bool moves_cursor();

/// Prints lines on stdout. A terminal cuts them to its width, and shows colours unless NO_COLOR is
/// set or TERM is "dumb". Elsewhere they are plain and cut to `width` columns.
void print_lines(const std::vector<Line>& lines, std::size_t width = 160);

/// Switches the terminal to its alternate screen, without echo and line buffer and with the cursor
/// hidden. The destructor restores the terminal. The class handles no signals: a caller that
/// catches none leaves the terminal changed when a signal ends the program.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  struct Size {
    std::size_t columns = 80;
    std::size_t rows = 24;
  };
  static Size size();
  void show(const std::vector<Line>& lines) const;
  /// Returns the next key without waiting; 0 if there is none. Arrows are 'A' to 'D', and page up
  /// and down '5' and '6', with bit 7 set.
  static int key();
  static constexpr int key_up = 'A' | 0x80;
  static constexpr int key_down = 'B' | 0x80;
  static constexpr int key_right = 'C' | 0x80;
  static constexpr int key_left = 'D' | 0x80;
  static constexpr int key_page_up = '5' | 0x80;
  static constexpr int key_page_down = '6' | 0x80;
};

}  // namespace takt
