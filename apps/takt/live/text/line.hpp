#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// Style of a text in a terminal.
enum class Paint : unsigned char { plain, title, dim, good, warning, bad };

/// A text in one style.
struct PaintedText {
  std::string text;
  Paint paint = Paint::plain;
};

/// One line of a terminal view, cut to the width of the terminal at a character boundary. The text
/// may come from other programs, so control characters are not printed.
class Line {
 public:
  Line& add(std::string_view text, Paint paint = Paint::plain);
  Line& add(const PaintedText& text) { return add(text.text, text.paint); }
  /// Returns the columns of the whole line.
  std::size_t columns() const noexcept;
  /// Returns the text for a terminal of `width` columns, with or without colours.
  std::string render(std::size_t width, bool colour) const;

 private:
  std::vector<PaintedText> pieces_;
};

/// Puts the items on lines of at most `width` columns, two spaces apart. An item that does not fit
/// begins a new line, which is indented by two columns. Empty items are left out.
std::vector<Line> flow(const std::vector<PaintedText>& items, std::size_t width);

void append(std::vector<Line>& lines, const std::vector<Line>& more);

/// Breaks a text at its spaces into lines of at most `width` columns. All lines but the first are
/// indented by `indent` columns. A word that is longer than a line is cut.
std::vector<Line> paragraph(std::string_view text, Paint paint, std::size_t width,
                            std::size_t indent);

/// Returns `text` padded with spaces to `width` columns, or cut if it is longer. left() aligns to
/// the left, right() to the right.
std::string left(std::string_view text, std::size_t width);
std::string right(std::string_view text, std::size_t width);

/// Returns `text`, with `~` instead of its middle if it is longer than `width` columns, so that
/// names that differ at their end stay different.
std::string shortened(std::string_view text, std::size_t width);

/// Returns a bar of `width` columns, filled up to a share of 0..1.
std::string bar(double share, std::size_t width);

}  // namespace takt
