#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "apps/takt/live/text/line.hpp"

namespace takt {

/// The way in which a table shows a text that is longer than its column.
enum class Cell : unsigned char {
  name,    ///< aligned to the left; a long text loses its middle
  words,   ///< aligned to the left; a long text loses its end
  number,  ///< aligned to the right, and never cut: a number that does not fit is shown as `###`
};

struct Column {
  std::string title;
  Cell kind = Cell::words;
  /// The number of columns that remain if the table is too wide; 0 means that the whole text
  /// remains.
  std::size_t least = 0;
  /// The number of columns that the column has at least where there is room, so that tables do not
  /// move while their texts change.
  std::size_t usual = 0;
};

/// A table that fits every width. Where there is not enough room, columns with `least` become
/// narrower. If that is not enough, each row takes several lines. No column disappears.
class Table {
 public:
  explicit Table(std::vector<Column> columns) : columns_{std::move(columns)} {}

  /// Adds a row with one cell for each column. Missing cells are empty.
  void add(std::vector<PaintedText> row);
  bool empty() const noexcept { return rows_.empty(); }

  /// The lines with the titles, and the lines of the rows.
  struct Text {
    std::vector<Line> head;
    std::vector<Line> body;
    std::vector<Line> all() const;  ///< the titles and the rows
  };
  Text text(std::size_t width) const;

 private:
  /// Columns that are printed on one line.
  struct Group {
    std::size_t first = 0;
    std::vector<std::size_t> widths;
    std::size_t indent = 0;
    std::size_t gap = 2;
  };

  std::size_t natural(std::size_t column) const;
  std::size_t least(std::size_t column) const;
  Group fitted(std::size_t first, std::size_t end, std::size_t indent, std::size_t width) const;
  std::vector<Group> groups(std::size_t width) const;
  Line line(const Group& group, const std::vector<PaintedText>& row) const;

  std::vector<Column> columns_;
  std::vector<std::vector<PaintedText>> rows_;
};

}  // namespace takt
