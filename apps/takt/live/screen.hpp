#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// Style of a text in a terminal.
enum class Paint : unsigned char { plain, title, dim, good, warning, bad };

/// One line of a terminal view, cut to the width of the terminal at a character boundary. The text
/// may come from other programs, so the line lets no control characters through.
class Line {
 public:
  Line& add(std::string_view text, Paint paint = Paint::plain);
  /// Returns the text for a terminal of `width` columns, with or without colours.
  std::string render(std::size_t width, bool colour) const;

 private:
  struct Piece {
    std::string text;
    Paint paint;
  };
  std::vector<Piece> pieces_;
};

/// Prints lines on stdout: in colours and cut to the width of a terminal, otherwise to `width`
/// columns.
void print_lines(const std::vector<Line>& lines, std::size_t width = 160);

/// Returns `text` padded with spaces to `width` columns, or cut if longer. UTF-8 counts by
/// character. left() aligns to the left, right() to the right.
std::string left(std::string_view text, std::size_t width);
std::string right(std::string_view text, std::size_t width);

/// Returns a bar of `width` columns, filled up to a share of 0..1.
std::string bar(double share, std::size_t width);

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
  /// Returns the next key without waiting; 0 if there is none. Arrows are 'A' (up) and 'B' (down)
  /// with bit 7 set.
  static int key();
  static constexpr int key_up = 'A' | 0x80;
  static constexpr int key_down = 'B' | 0x80;
};

}  // namespace takt
