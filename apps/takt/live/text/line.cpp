#include "apps/takt/live/text/line.hpp"

#include <algorithm>
#include <cmath>

#include "apps/takt/live/text/character_width.hpp"
#include "eds_parser/values/name_of.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

std::string_view escape(Paint paint) noexcept {
  static constexpr std::string_view sequences[]{"",         "\033[1m",  "\033[2m",
                                                "\033[32m", "\033[33m", "\033[1;31m"};
  return name_of(paint, sequences);
}

}  // namespace

Line& Line::add(std::string_view text, Paint paint) {
  if (!text.empty()) pieces_.push_back({printable_text(text), paint});
  return *this;
}

std::size_t Line::columns() const noexcept {
  std::size_t columns = 0;
  for (const PaintedText& piece : pieces_) columns += columns_of(piece.text);
  return columns;
}

std::string Line::render(std::size_t width, bool colour) const {
  std::string text;
  for (const PaintedText& piece : pieces_) {
    const std::string_view shown = first_columns(piece.text, width);
    width -= columns_of(shown);
    const bool painted = colour && piece.paint != Paint::plain;
    if (painted) text += escape(piece.paint);
    text += shown;
    if (painted) text += "\033[0m";
    if (shown.size() < piece.text.size()) break;
  }
  return text;
}

std::vector<Line> flow(const std::vector<PaintedText>& items, std::size_t width) {
  constexpr std::size_t gap = 2;
  std::vector<Line> lines;
  std::size_t used = 0;
  for (const PaintedText& item : items) {
    if (item.text.empty()) continue;
    const std::size_t columns = columns_of(printable_text(item.text));
    const bool begins = lines.empty() || used + gap + columns > width;
    if (begins) {
      const bool first = lines.empty();
      lines.emplace_back();
      used = first ? 0 : gap;
      if (!first) lines.back().add("  ");
    } else {
      lines.back().add("  ");
      used += gap;
    }
    const std::size_t room = width > used ? width - used : 1;
    lines.back().add(shortened(item.text, room), item.paint);
    used += std::min(columns, room);
  }
  return lines;
}

void append(std::vector<Line>& lines, const std::vector<Line>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

std::vector<Line> paragraph(std::string_view text, Paint paint, std::size_t width,
                            std::size_t indent) {
  const std::string clean = printable_text(text);
  std::vector<std::string> lines;
  std::size_t from = 0;
  while ((from = clean.find_first_not_of(' ', from)) != clean.npos) {
    const std::size_t end = std::min(clean.find(' ', from), clean.size());
    const std::string_view word = std::string_view{clean}.substr(from, end - from);
    from = end;
    if (!lines.empty() && columns_of(lines.back()) + 1 + columns_of(word) <= width) {
      lines.back().append(1, ' ').append(word);
      continue;
    }
    const std::size_t space = lines.empty() ? 0 : std::min(indent, width / 2);
    lines.push_back(std::string(space, ' ').append(shortened(word, width - space)));
  }
  std::vector<Line> painted;
  for (const std::string& line : lines) painted.push_back(Line{}.add(line, paint));
  return painted;
}

std::string left(std::string_view text, std::size_t width) {
  std::string padded{first_columns(text, width)};
  return padded.append(width - columns_of(padded), ' ');
}

std::string right(std::string_view text, std::size_t width) {
  const std::size_t columns = columns_of(text);
  if (columns >= width) return left(text, width);
  return std::string(width - columns, ' ') + std::string{text};
}

std::string shortened(std::string_view text, std::size_t width) {
  if (columns_of(text) <= width) return std::string{text};
  if (width == 0) return {};
  const std::size_t end = (width - 1) / 2;
  return std::string{first_columns(text, width - 1 - end)} + '~' +
         std::string{last_columns(text, end)};
}

std::string bar(double share, std::size_t width) {
  const double bounded = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  const auto full = static_cast<std::size_t>(std::lround(bounded * static_cast<double>(width)));
  std::string text;
  for (std::size_t i = 0; i < width; ++i) text += i < full ? "\u2588" : "\u2591";
  return text;
}

}  // namespace takt
