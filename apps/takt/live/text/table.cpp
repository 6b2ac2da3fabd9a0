#include "apps/takt/live/text/table.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "apps/takt/live/text/character_width.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr std::size_t continued_indent = 2;

std::string cell_text(std::string_view text, Cell kind, std::size_t width) {
  if (width == 0) return {};
  const bool fits = columns_of(text) <= width;
  switch (kind) {
    case Cell::name:
      return left(shortened(text, width), width);
    case Cell::words:
      return fits ? left(text, width) : left(text, width - 1) + '~';
    case Cell::number:
      return fits ? right(text, width) : std::string(width, '#');
  }
  return {};
}

}  // namespace

void Table::add(std::vector<PaintedText> row) {
  row.resize(columns_.size());
  for (PaintedText& cell : row) cell.text = printable_text(cell.text);
  rows_.push_back(std::move(row));
}

std::size_t Table::natural(std::size_t column) const {
  std::size_t columns = std::max(columns_of(columns_[column].title), columns_[column].usual);
  for (const auto& row : rows_) columns = std::max(columns, columns_of(row[column].text));
  return columns;
}

std::size_t Table::least(std::size_t column) const {
  const std::size_t whole = natural(column);
  if (columns_[column].least == 0) return whole;
  return std::min(whole, std::max(columns_[column].least, columns_of(columns_[column].title)));
}

/// Makes the widest columns narrower until the line fits.
Table::Group Table::fitted(std::size_t first, std::size_t end, std::size_t indent,
                           std::size_t width) const {
  Group group{.first = first, .widths = {}, .indent = indent};
  std::vector<std::size_t> spare;
  for (std::size_t i = first; i < end; ++i) {
    group.widths.push_back(natural(i));
    spare.push_back(group.widths.back() - least(i));
  }
  const std::size_t gaps = group.widths.size() - 1;
  const auto used = [&] {
    return std::accumulate(group.widths.begin(), group.widths.end(), indent + gaps * group.gap);
  };
  if (used() > width) group.gap = 1;
  while (used() > width) {
    const auto widest = std::ranges::max_element(spare);
    if (*widest == 0) break;
    --*widest;
    --group.widths[static_cast<std::size_t>(widest - spare.begin())];
  }
  // One column alone may still be wider than the line.
  const std::size_t room = width > indent ? width - indent : 1;
  if (group.widths.size() == 1) group.widths[0] = std::min(group.widths[0], room);
  return group;
}

std::vector<Table::Group> Table::groups(std::size_t width) const {
  std::vector<Group> groups;
  std::size_t first = 0;
  while (first < columns_.size()) {
    const std::size_t indent = first == 0 ? 0 : continued_indent;
    std::size_t used = indent + least(first);
    std::size_t end = first + 1;
    while (end < columns_.size() && used + 1 + least(end) <= width) used += 1 + least(end++);
    groups.push_back(fitted(first, end, indent, width));
    first = end;
  }
  return groups;
}

Line Table::line(const Group& group, const std::vector<PaintedText>& row) const {
  Line line;
  std::string space(group.indent, ' ');
  for (std::size_t i = 0; i < group.widths.size(); ++i) {
    const PaintedText& cell = row[group.first + i];
    const Cell kind = columns_[group.first + i].kind;
    std::string text = cell_text(cell.text, kind, group.widths[i]);
    const std::size_t end = text.find_last_not_of(' ') + 1;
    if (end != 0) {
      line.add(space).add(std::string_view{text}.substr(0, end), cell.paint);
      space.clear();
    }
    space.append(text.size() - end + group.gap, ' ');
  }
  return line;
}

std::vector<Line> Table::Text::all() const {
  std::vector<Line> lines = head;
  lines.insert(lines.end(), body.begin(), body.end());
  return lines;
}

Table::Text Table::text(std::size_t width) const {
  std::vector<PaintedText> titles;
  for (const Column& column : columns_) titles.push_back({column.title, Paint::dim});
  Text text;
  const std::vector<Group> all = groups(std::max<std::size_t>(width, 1));
  for (const Group& group : all) text.head.push_back(line(group, titles));
  for (const auto& row : rows_) {
    for (const Group& group : all) text.body.push_back(line(group, row));
  }
  return text;
}

}  // namespace takt
