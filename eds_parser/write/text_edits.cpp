#include "eds_parser/write/text_edits.hpp"

#include <algorithm>
#include <utility>

namespace takt {

TextEdits::TextEdits(std::string_view text) : text_{text} {
  const auto end = text.find_first_of("\r\n");
  if (end == std::string_view::npos) return;
  line_end_ = text.substr(end).starts_with("\r\n") ? "\r\n" : text[end] == '\r' ? "\r" : "\n";
}

void TextEdits::replace(std::string_view part, std::string with) {
  edits_.push_back({offset(part), part.size(), std::move(with), false});
}

void TextEdits::insert_line_after(std::string_view anchor, std::string_view line) {
  auto at = text_.find_first_of("\r\n", offset(anchor) + anchor.size());
  if (at == std::string_view::npos) return append_line(line);
  at += text_.substr(at).starts_with("\r\n") ? 2 : 1;
  add_line(at, line);
}

void TextEdits::append_line(std::string_view line) { add_line(text_.size(), line); }

void TextEdits::add_line(std::size_t at, std::string_view line) {
  edits_.push_back({at, 0, std::string{line}.append(line_end_), true});
}

std::string TextEdits::apply() && {
  // Insertions come before removals at the same place.
  std::ranges::stable_sort(edits_, {},
                           [](const Edit& edit) { return std::pair{edit.at, edit.length != 0}; });
  std::string out;
  std::size_t taken = 0;
  for (const auto& edit : edits_) {
    if (edit.at < taken) continue;
    out += text_.substr(taken, edit.at - taken);
    const bool open = edit.is_line && !out.empty() && out.back() != '\n' && out.back() != '\r';
    if (open) out += line_end_;
    out += edit.with;
    taken = edit.at + edit.length;
  }
  return out += text_.substr(taken);
}

}  // namespace takt
