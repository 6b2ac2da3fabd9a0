#include "apps/command_line/help_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::size_t usual_width = 80;
constexpr std::size_t narrow = 70;     // in narrower terminals, descriptions are below the names
constexpr std::size_t full_line = 70;  // a line of at least this length continues in the next one
constexpr std::size_t narrow_indent = 6;

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Breaks texts into lines.
class Wrapper {
 public:
  explicit Wrapper(std::size_t width) : width_{width} {}

  /// Appends a text. The first line continues the last line of the output, and the others begin at
  /// `indent`.
  void add(std::string_view text, std::size_t indent) {
    bool first = true;
    while (!(text = trimmed(text)).empty()) {
      const std::string_view word = text.substr(0, text.find(' '));
      text.remove_prefix(word.size());
      if (!first && column() + 1 + word.size() > width_) {
        out_ += '\n' + std::string(indent, ' ');
      } else if (!first) {
        out_ += ' ';
      }
      out_ += word;
      first = false;
    }
  }
  void line(std::string_view text, std::size_t indent) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    if (text.size() <= width_) {
      out_ += text;
    } else {
      out_ += text.substr(0, begin);
      add(text, indent);
    }
    out_ += '\n';
  }
  /// Appends a name and its description, which begins at `at`.
  void entry(std::string_view name, std::string_view description, std::size_t at) {
    out_ += "  ";
    add(name, narrow_indent);
    if (!description.empty()) {
      out_ += column() + 1 > at ? '\n' + std::string(at, ' ') : std::string(at - column(), ' ');
      add(description, at);
    }
    out_ += '\n';
  }
  std::string take() { return std::move(out_); }

 private:
  std::size_t column() const {
    const std::size_t end = out_.rfind('\n');
    return end == out_.npos ? out_.size() : out_.size() - end - 1;
  }

  std::size_t width_;
  std::string out_;
};

/// Returns the name on a line of an option or a command. The description may follow on the same
/// line.
std::string_view name_on(std::string_view line, std::size_t column) {
  const bool joined = line.size() > column && line[column - 1] == ' ';
  return trimmed(joined ? line.substr(0, column) : line);
}

/// Returns the column of the descriptions: after the longest name that leaves room for a
/// description.
std::size_t description_column(const std::vector<std::string_view>& lines, std::size_t column) {
  std::size_t longest_name = 0;
  for (const std::string_view line : lines) {
    if (!line.starts_with("  ") || line.starts_with("   ")) continue;
    const std::size_t size = name_on(line, column).size();
    if (size + 3 < column) longest_name = std::max(longest_name, size);
  }
  return longest_name + 4;
}

void add_options(std::string_view text, std::size_t column, Wrapper& out, std::size_t width) {
  const std::string gap(column, ' ');
  const auto lines = lines_of(text);
  const std::size_t at = width < narrow ? narrow_indent : description_column(lines, column);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    if (!line.starts_with("  ")) {
      out.line(line, line.starts_with("Usage") ? narrow_indent : 0);
      continue;
    }
    const std::string_view name = name_on(line, column);
    std::string description{
        name.size() + 2 <= column ? trimmed(line.substr(std::min(column, line.size()))) : ""};
    for (; i + 1 < lines.size() && lines[i + 1].starts_with(gap); ++i) {
      description += ' ' + std::string{trimmed(lines[i + 1])};
    }
    out.entry(name, description, at);
  }
}

/// Joins lines that were broken only because the lines of the source code are limited, and breaks
/// them anew.
void add_notes(std::string_view text, Wrapper& out) {
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string paragraph{lines[i]};
    const bool is_example = paragraph.starts_with(' ');
    while (!is_example && i + 1 < lines.size() && lines[i].size() >= full_line &&
           !lines[i + 1].empty() && !lines[i + 1].starts_with(' ')) {
      paragraph += ' ' + std::string{lines[++i]};
    }
    out.line(paragraph, is_example ? 4 : 0);
  }
}

}  // namespace

std::size_t text_width() {
  winsize window{};
  std::size_t width = usual_width;
  const char* columns = std::getenv("COLUMNS");
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col != 0) {
    width = window.ws_col;
  } else if (columns != nullptr) {
    width = number_in<std::size_t>(columns).value_or(usual_width);
  }
  return std::clamp<std::size_t>(width, 40, 100);
}

std::vector<std::string> broken(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  while (text.size() > width) {
    const std::size_t blank = text.substr(0, width + 1).rfind(' ');
    const std::size_t end = blank == text.npos || blank == 0 ? width : blank;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  }
  lines.emplace_back(text);
  return lines;
}

std::string wrapped_help(std::string_view options, std::size_t column, std::string_view notes,
                         std::size_t width) {
  Wrapper out{width};
  add_options(options, column, out, width);
  add_notes(notes, out);
  return out.take();
}

}  // namespace takt
