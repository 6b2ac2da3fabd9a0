#include "eds_parser/ini.hpp"

#include <algorithm>
#include <cstring>

#include "eds_parser/text.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_line = 255;  // CiA 306, 4.2

/// Cuts a text into lines, whatever ends them.
class Lines {
 public:
  explicit Lines(std::string_view text) noexcept
      : at_{text.data()}, end_{text.data() + text.size()} {
    lf_ = next('\n');
    cr_ = next('\r');
  }

  bool done() const noexcept { return at_ == end_; }

  std::string_view take() noexcept {
    if (lf_ < at_) lf_ = next('\n');
    if (cr_ < at_) cr_ = next('\r');
    const char* stop = std::min(lf_, cr_);
    const std::string_view line{at_, static_cast<std::size_t>(stop - at_)};
    at_ = stop;
    if (at_ != end_ && *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    if (at_ != end_) ++at_;
    return line;
  }

 private:
  const char* next(char c) const noexcept {
    const auto* found = std::memchr(at_, c, static_cast<std::size_t>(end_ - at_));
    return found == nullptr ? end_ : static_cast<const char*>(found);
  }

  const char* at_;
  const char* end_;
  const char* lf_ = nullptr;
  const char* cr_ = nullptr;
};

class Reader {
 public:
  Reader(IniFile& file, Report& report) noexcept : file_{file}, report_{report} {}

  void read(std::string_view text) {
    file_.all_entries.reserve(text.size() / 24 + 16);
    file_.sections.reserve(text.size() / 160 + 16);
    for (Lines lines{text}; !lines.done();) {
      line_ = lines.take();
      ++number_;
      read_line();
    }
    close_section();
  }

 private:
  void read_line() {
    const char* at = line_.data();
    const char* const end = at + line_.size();
    while (at != end && is_blank(*at)) ++at;
    if (at == end || *at == ';') return;
    const auto rest = trim({at, static_cast<std::size_t>(end - at)});
    if (rest.front() == '[') {
      read_header(rest);
    } else if (rest.front() == '#') {
      report_.note(here(rest), "hash-comment",
                   "'#' does not start a comment in CiA 306, taken as one; use ';'");
    } else {
      read_entry(rest);
    }
    if (line_.size() > longest_line && report_.wants("long-line")) {
      report_.warning({number_, 1}, "long-line",
                      "line of " + std::to_string(line_.size()) +
                          " characters; CiA 306 allows 255, other tools may cut it");
    }
  }

  void read_header(std::string_view rest) {
    const auto close = rest.find(']');
    if (close == std::string_view::npos) {
      return leave_out("section-not-closed", "']' is missing", rest);
    }
    const auto behind = trim(rest.substr(close + 1));
    if (!behind.empty() && behind.front() != ';' && report_.wants("text-after-section")) {
      report_.note(here(behind), "text-after-section",
                   "text behind ']' is left out: " + quoted(behind));
    }
    close_section();
    file_.sections.push_back({trim(rest.substr(1, close - 1)), here(rest),
                              static_cast<std::uint32_t>(file_.all_entries.size()), 0});
  }

  void read_entry(std::string_view rest) {
    const auto* equals = static_cast<const char*>(std::memchr(rest.data(), '=', rest.size()));
    if (equals == nullptr) {
      return leave_out("no-equals", "neither [section] nor key=value", rest);
    }
    const auto length = static_cast<std::size_t>(equals - rest.data());
    const auto key = trim(rest.substr(0, length));
    auto value = rest.substr(length + 1);
    while (!value.empty() && is_blank(value.front())) value.remove_prefix(1);
    if (file_.sections.empty()) {
      return leave_out("entry-outside-section", "entry before the first [section]", rest);
    }
    file_.all_entries.push_back({key, value, number_, column(rest), column(value)});
  }

  void leave_out(std::string_view rule, std::string_view why, std::string_view line) {
    if (!report_.wants(rule)) return;
    report_.warning(here(line), rule, std::string{why} + "; the line is left out: " + quoted(line));
  }

  void close_section() noexcept {
    if (file_.sections.empty()) return;
    auto& last = file_.sections.back();
    last.count = static_cast<std::uint32_t>(file_.all_entries.size()) - last.first;
  }

  std::uint32_t column(std::string_view part) const noexcept {
    return static_cast<std::uint32_t>(part.data() - line_.data()) + 1;
  }
  SourcePos here(std::string_view part) const noexcept { return {number_, column(part)}; }

  IniFile& file_;
  Report& report_;
  std::string_view line_;
  std::uint32_t number_ = 0;
};

/// UTF-16 by its mark, or by the NULs that every second byte of ASCII text then is.
enum class Encoding : std::uint8_t { bytes, utf16_le, utf16_be };

Encoding encoding_of(std::string_view text) noexcept {
  if (text.starts_with("\xFF\xFE")) return Encoding::utf16_le;
  if (text.starts_with("\xFE\xFF")) return Encoding::utf16_be;
  if (text.size() >= 4 && text[0] != 0 && text[1] == 0 && text[2] != 0 && text[3] == 0) {
    return Encoding::utf16_le;
  }
  if (text.size() >= 4 && text[0] == 0 && text[1] != 0 && text[2] == 0 && text[3] != 0) {
    return Encoding::utf16_be;
  }
  return Encoding::bytes;
}

}  // namespace

IniFile read_ini(std::string_view text, Report& report) {
  IniFile file;
  const auto encoding = encoding_of(text);
  if (encoding != Encoding::bytes) {
    report.warning({}, "utf-16", "the file is UTF-16, CiA 306 asks for ASCII; it was converted");
    file.recoded =
        std::make_unique<std::string>(utf16_to_utf8(text, encoding == Encoding::utf16_be));
    text = *file.recoded;
  }
  if (text.starts_with("\xEF\xBB\xBF")) {
    report.note({}, "byte-order-mark", "the file starts with a byte order mark; it was skipped");
    text.remove_prefix(3);
  }
  Reader{file, report}.read(text);
  return file;
}

}  // namespace takt
