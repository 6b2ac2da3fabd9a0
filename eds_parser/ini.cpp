#include "eds_parser/ini.hpp"

#include "eds_parser/text.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_line = 255;  // CiA 306, 4.2

/// Cuts a text into lines, whatever ends them, and notes the first `=` of each on the way.
class Lines {
 public:
  explicit Lines(std::string_view text) noexcept
      : at_{text.data()}, end_{text.data() + text.size()} {}

  bool done() const noexcept { return at_ == end_; }
  /// Of the line taken last; nullptr where it has none.
  const char* equals() const noexcept { return equals_; }

  std::string_view take() noexcept {
    const char* const first = at_;
    equals_ = nullptr;
    const char* at = first;
    for (; at != end_ && *at != '\n' && *at != '\r'; ++at) {
      if (*at == '=' && equals_ == nullptr) equals_ = at;
    }
    at_ = at;
    if (at_ != end_ && *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    if (at_ != end_) ++at_;
    return {first, static_cast<std::size_t>(at - first)};
  }

 private:
  const char* at_;
  const char* end_;
  const char* equals_ = nullptr;
};

class Reader {
 public:
  Reader(IniFile& file, Report& report) noexcept : file_{file}, report_{report} {}

  void read(std::string_view text) {
    file_.all_entries.reserve(text.size() / 24 + 16);
    file_.sections.reserve(text.size() / 160 + 16);
    for (Lines lines{text}; !lines.done();) {
      line_ = lines.take();
      equals_ = lines.equals();
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
    if (equals_ == nullptr) {
      return leave_out("no-equals", "neither [section] nor key=value", rest);
    }
    const auto length = static_cast<std::size_t>(equals_ - rest.data());
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
  const char* equals_ = nullptr;  ///< first `=` of the line
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
