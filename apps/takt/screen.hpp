#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// How text is painted in a terminal.
enum class Paint : unsigned char { plain, title, dim, good, warning, bad };

/// One line of a terminal view, cut to the width of the terminal by whole characters. What is in
/// it comes from outside, so control characters are not let through.
class Line {
 public:
  Line& add(std::string_view text, Paint paint = Paint::plain);
  /// As text for a terminal of `width` columns, with or without colours.
  std::string render(std::size_t width, bool colour) const;

 private:
  struct Piece {
    std::string text;
    Paint paint;
  };
  std::vector<Piece> pieces_;
};

/// `text` with spaces up to `width` columns (UTF-8 counts by character), cut where longer.
std::string left(std::string_view text, std::size_t width);
std::string right(std::string_view text, std::size_t width);

/// `#######---` of `width` columns for a share of 0..1.
std::string bar(double share, std::size_t width);

/// The terminal as a screen of its own while this lives: no echo, no line buffer, cursor hidden.
/// Put back whatever ends the program, except SIGKILL.
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
  /// Next key without waiting; 0: none. Arrows are 'A' up and 'B' down with bit 7.
  static int key();
  static constexpr int key_up = 'A' | 0x80;
  static constexpr int key_down = 'B' | 0x80;
};

}  // namespace takt
