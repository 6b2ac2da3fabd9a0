#include "eds_parser/report/text_diff.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "eds_parser/report/message.hpp"

namespace takt {
namespace {

using TextLines = std::span<const std::string_view>;
using Kind = DiffLine::Kind;

constexpr std::size_t most_cells = 1'000'000;  // size limit of the table for repeated lines

/// The positions of a line that occurs once in `before` and once in `after`.
struct Anchor {
  std::size_t before = 0;
  std::size_t after = 0;
};

/// Returns the longest sequence of anchors that ascends in both texts. `anchors` must ascend in
/// `before`.
std::vector<Anchor> ascending(const std::vector<Anchor>& anchors) {
  std::vector<std::size_t> tails;  // index of the last anchor of the best run of each length
  std::vector<std::size_t> previous(anchors.size());
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const auto at = std::ranges::lower_bound(tails, anchors[i].after, {},
                                             [&](std::size_t t) { return anchors[t].after; });
    previous[i] = at == tails.begin() ? i : *(at - 1);
    if (at == tails.end()) {
      tails.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<Anchor> run(tails.size());
  for (std::size_t length = tails.size(), i = tails.empty() ? 0 : tails.back(); length-- > 0;) {
    run[length] = anchors[i];
    i = previous[i];
  }
  return run;
}

std::vector<Anchor> anchors_of(TextLines before, TextLines after) {
  struct Seen {
    std::size_t in_before = 0;
    std::size_t in_after = 0;
    std::size_t position = 0;  // index of the line in `after`
  };
  std::map<std::string_view, Seen> seen;
  for (const std::string_view line : before) ++seen[line].in_before;
  for (std::size_t i = 0; i < after.size(); ++i) {
    Seen& line = seen[after[i]];
    ++line.in_after;
    line.position = i;
  }
  std::vector<Anchor> anchors;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Seen& line = seen[before[i]];
    if (line.in_before == 1 && line.in_after == 1) anchors.push_back({i, line.position});
  }
  return ascending(anchors);
}

class Differ {
 public:
  std::vector<DiffLine> run(TextLines before, TextLines after) {
    range(before, after);
    return std::move(out_);
  }

 private:
  void add(Kind kind, TextLines lines) {
    for (const std::string_view line : lines) out_.push_back({kind, line});
  }

  /// Compares a range of lines. The lines that both texts have in common at the beginning and at
  /// the end are equal; middle() compares the lines between them.
  void range(TextLines before, TextLines after) {
    std::size_t head = 0;
    const std::size_t least = std::min(before.size(), after.size());
    while (head < least && before[head] == after[head]) ++head;
    add(Kind::same, before.first(head));
    before = before.subspan(head);
    after = after.subspan(head);
    std::size_t tail = 0;
    while (tail < std::min(before.size(), after.size()) &&
           before[before.size() - 1 - tail] == after[after.size() - 1 - tail]) {
      ++tail;
    }
    const TextLines end = before.last(tail);
    middle(before.first(before.size() - tail), after.first(after.size() - tail));
    add(Kind::same, end);
  }

  void middle(TextLines before, TextLines after) {
    const std::vector<Anchor> anchors =
        before.empty() || after.empty() ? std::vector<Anchor>{} : anchors_of(before, after);
    if (anchors.empty()) return repeated(before, after);
    Anchor done;
    for (const Anchor& anchor : anchors) {
      range(before.subspan(done.before, anchor.before - done.before),
            after.subspan(done.after, anchor.after - done.after));
      add(Kind::same, before.subspan(anchor.before, 1));
      done = {anchor.before + 1, anchor.after + 1};
    }
    range(before.subspan(done.before), after.subspan(done.after));
  }

  /// Compares lines without an anchor by their longest common subsequence, which a table finds. If
  /// the table would become too large, all lines count as changed.
  void repeated(TextLines before, TextLines after) {
    const std::size_t width = after.size() + 1;
    if (before.empty() || after.empty() || (before.size() + 1) * width > most_cells) {
      add(Kind::removed, before);
      add(Kind::added, after);
      return;
    }
    std::vector<std::uint32_t> longest((before.size() + 1) * width, 0);
    for (std::size_t i = before.size(); i-- > 0;) {
      for (std::size_t k = after.size(); k-- > 0;) {
        longest[i * width + k] = before[i] == after[k] ? longest[(i + 1) * width + k + 1] + 1
                                                       : std::max(longest[(i + 1) * width + k],
                                                                  longest[i * width + k + 1]);
      }
    }
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < before.size() && k < after.size()) {
      if (before[i] == after[k]) {
        out_.push_back({Kind::same, before[i]});
        ++i, ++k;
      } else if (longest[(i + 1) * width + k] >= longest[i * width + k + 1]) {
        out_.push_back({Kind::removed, before[i++]});
      } else {
        out_.push_back({Kind::added, after[k++]});
      }
    }
    add(Kind::removed, before.subspan(i));
    add(Kind::added, after.subspan(k));
  }

  std::vector<DiffLine> out_;
};

/// Returns a line range: `12`, `12,3`, or `11,0` if a side has no lines.
std::string range_text(std::size_t lines_before, std::size_t count) {
  const std::size_t first = count == 0 ? lines_before : lines_before + 1;
  return std::to_string(first) + (count == 1 ? "" : ',' + std::to_string(count));
}

using Write = void (*)(std::string& out, std::string_view line);

std::string_view without_end(std::string_view line) noexcept {
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string hunks_of(std::span<const DiffLine> lines, bool (*heading)(std::string_view),
                     std::size_t context, Write write) {
  std::string out;
  std::string_view title;
  std::size_t before = 0;  // number of lines of each text before this line
  std::size_t after = 0;
  const auto pass = [&](const DiffLine& line) {
    if (line.kind != Kind::added) ++before;
    if (line.kind != Kind::removed) ++after;
    if (heading(line.text)) title = without_end(line.text);
  };
  for (std::size_t at = 0; at < lines.size();) {
    const auto changed = [&](std::size_t from) {
      while (from < lines.size() && lines[from].kind == Kind::same) ++from;
      return from;
    };
    const std::size_t first = changed(at);
    if (first == lines.size()) break;
    const std::size_t begin = std::max(at, first - std::min(first, context));
    while (at < begin) pass(lines[at++]);
    std::size_t end = first;
    for (std::size_t next = first; next < lines.size() && next <= end + 2 * context;
         next = changed(end)) {
      end = next + 1;
    }
    end = std::min(end + context, lines.size());
    const std::size_t first_before = before;
    const std::size_t first_after = after;
    const std::string hunk_title{title};
    std::string body;
    for (; at < end; ++at) {
      constexpr std::string_view marks = " -+";
      body += marks[static_cast<std::size_t>(lines[at].kind)];
      write(body, lines[at].text);
      pass(lines[at]);
    }
    out += concat("@@ -", range_text(first_before, before - first_before), " +",
                  range_text(first_after, after - first_after), " @@",
                  hunk_title.empty() ? "" : " ", hunk_title, "\n", body);
  }
  return out;
}

/// Returns the lines with their ends. Only LF ends a line, as for `diff` and `patch`.
std::vector<std::string_view> whole_lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.push_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  return lines;
}

void write_line(std::string& out, std::string_view line) { (out += line) += '\n'; }

void write_whole_line(std::string& out, std::string_view line) {
  out += line;
  if (!line.ends_with('\n')) out += "\n\\ No newline at end of file\n";
}

bool only_carriage_returns(std::string_view text) noexcept {
  return text.contains('\r') && !text.contains('\n');
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
    if (text.starts_with("\r\n")) text.remove_prefix(1);
    if (!text.empty()) text.remove_prefix(1);
  }
  return lines;
}

std::vector<DiffLine> diff_lines(TextLines before, TextLines after) {
  return Differ{}.run(before, after);
}

std::string unified_hunks(std::span<const DiffLine> lines, bool (*heading)(std::string_view),
                          std::size_t context) {
  return hunks_of(lines, heading, context, write_line);
}

std::string unified_diff(std::string_view before, std::string_view after,
                         const std::string& before_name, const std::string& after_name,
                         bool (*heading)(std::string_view)) {
  const bool shown_only = only_carriage_returns(before) && only_carriage_returns(after);
  const auto split = shown_only ? lines_of : whole_lines_of;
  const auto old_lines = split(before);
  const auto new_lines = split(after);
  const std::string hunks = hunks_of(diff_lines(old_lines, new_lines), heading, 3,
                                     shown_only ? write_line : write_whole_line);
  return hunks.empty() ? "" : "--- " + before_name + "\n+++ " + after_name + '\n' + hunks;
}

}  // namespace takt
