#include "eds_parser/ini/ini.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "eds_parser/values/ids.hpp"

namespace takt {
namespace {

constexpr std::ptrdiff_t longest_line = 255;  // CiA 306, 4.2

struct IniLine {
  const char* first;
  const char* last;              ///< position after the last character
  const char* equals = nullptr;  ///< the first `=`, if any
};

/// Splits a text into lines at any kind of line end, and notes the first `=` of each line. The
/// class examines 64 bytes at a time and remembers the positions of control characters and `=`.
class Lines {
 public:
  explicit Lines(std::string_view text) noexcept
      : at_{text.data()}, end_{text.data() + text.size()}, block_{at_} {
    mark();
  }

  bool done() const noexcept { return at_ == end_; }

  IniLine take() noexcept {
    IniLine line{.first = at_, .last = next()};
    while (line.last != end_ && *line.last == '=') {
      if (line.equals == nullptr) line.equals = line.last;
      line.last = next();
    }
    while (line.last != end_ && *line.last != '\n' && *line.last != '\r') take_odd(line);
    at_ = line.last;
    if (at_ == end_) return line;
    const bool two = *at_ == '\r' && end_ - at_ > 1 && at_[1] == '\n';
    if (two) next();
    at_ += two ? 2 : 1;
    return line;
  }

 private:
  static constexpr std::uint64_t ones = 0x0101'0101'0101'0101;
  static constexpr std::uint64_t tops = ones << 7;
  static constexpr std::size_t block_size = 64;

  /// Handles tabs, other control characters, and bytes that only look like one of these characters.
  void take_odd(IniLine& line) noexcept {
    if (*line.last == '=' && line.equals == nullptr) line.equals = line.last;
    line.last = next();
  }

  /// Returns the next character that may matter, or the end. The function finds every control
  /// character and every `=`, and few others.
  const char* next() noexcept {
    while (marks_ == 0) {
      if (end_ - block_ <= static_cast<std::ptrdiff_t>(block_size)) return end_;
      block_ += block_size;
      mark();
    }
    const char* const at = block_ + std::countr_zero(marks_);
    marks_ &= marks_ - 1;
    return at;
  }

  void mark() noexcept {
    if (end_ - block_ >= static_cast<std::ptrdiff_t>(block_size)) {
      marks_ = marks_of(block_);
      return;
    }
    std::array<char, block_size> last;
    last.fill(' ');
    std::copy(block_, end_, last.begin());
    marks_ = marks_of(last.data());
  }

  static std::uint64_t marks_of(const char* block) noexcept {
    std::uint64_t marks = 0;
    for (std::size_t at = 0; at < block_size; at += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, block + at, 8);
      if constexpr (std::endian::native == std::endian::big) eight = std::byteswap(eight);
      const std::uint64_t other = eight ^ (ones * '=');
      const std::uint64_t found = ((eight - ones * ' ') & ~eight) | ((other - ones) & ~other);
      // Packs bit 7 of each byte into adjacent bits.
      marks |= (((found & tops) >> 7) * 0x0102'0408'1020'4080 >> 56) << at;
    }
    return marks;
  }

  const char* at_;
  const char* end_;
  const char* block_;
  std::uint64_t marks_ = 0;  ///< bit n: block_[n] may matter and is not handled yet
};

class Reader {
 public:
  Reader(IniFile& file, Report& report) noexcept : file_{file}, report_{report} {}

  void read(std::string_view text) {
    file_.text = text.data();
    file_.spots.reserve(text.size() / 16 + 16);
    file_.sections.reserve(text.size() / 128 + 16);
    for (Lines lines{text}; !lines.done();) {
      ++number_;
      read_line(lines.take());
    }
    close_section();
  }

 private:
  void read_line(const IniLine& line) {
    const char* first = line.first;
    const char* last = line.last;
    while (first != last && is_blank(*first)) ++first;
    while (first != last && is_blank(last[-1])) --last;
    if (first == last || *first == ';') return;
    start_ = line.first;
    if (line.equals != nullptr && *first != '[' && *first != '#') {
      read_entry(first, line.equals, last);
    } else {
      read_other({first, static_cast<std::size_t>(last - first)});
    }
    if (line.last - line.first > longest_line) report_long(line);
  }

  void read_entry(const char* key, const char* equals, const char* last) {
    if (file_.sections.empty()) {
      return leave_out("entry-outside-section", "entry before the first [section]",
                       {key, static_cast<std::size_t>(last - key)});
    }
    file_.spots.push_back(
        {.key = offset(key), .equals = offset(equals), .end = offset(last), .line = number_});
  }

  /// Handles a line that is neither blank nor an entry.
  void read_other(std::string_view rest) {
    if (rest.front() == '[') {
      read_header(rest);
    } else if (rest.front() == '#') {
      report_.note(here(rest), "hash-comment",
                   "'#' does not start a comment in CiA 306, but was read as one; use ';'");
    } else {
      leave_out("no-equals", "neither [section] nor key=value", rest);
    }
  }

  void report_long(const IniLine& line) {
    report_.warning({number_, 1}, "long-line", "line of ", line.last - line.first,
                    " characters; CiA 306 allows 255, other tools may cut it");
  }

  void read_header(std::string_view rest) {
    const auto close = rest.find(']');
    if (close == std::string_view::npos) return read_open_header(rest);
    const auto behind = trim(rest.substr(close + 1));
    if (!behind.empty() && behind.front() != ';') {
      report_.note(here(behind), "text-after-section",
                   "text behind ']' is left out: ", Quoted{behind});
    }
    close_section();
    file_.sections.push_back({trim(rest.substr(1, close - 1)), here(rest),
                              static_cast<std::uint32_t>(file_.spots.size())});
  }

  /// Starts a section whose ] is missing. The following entries belong to it, not to the section
  /// before.
  void read_open_header(std::string_view rest) {
    rest = trim(rest.substr(0, rest.find(';')));
    report_.warning(here(rest), "section-not-closed", "']' is missing behind ", Quoted{rest},
                    "; read as if it were there");
    close_section();
    file_.sections.push_back({.name = trim(rest.substr(1)),
                              .pos = here(rest),
                              .first = static_cast<std::uint32_t>(file_.spots.size()),
                              .closed = false});
  }

  void leave_out(std::string_view rule, std::string_view why, std::string_view line) {
    report_.warning(here(line), rule, why, "; the line is left out: ", Quoted{line});
  }

  void close_section() noexcept {
    if (file_.sections.empty()) return;
    auto& last = file_.sections.back();
    last.count = static_cast<std::uint32_t>(file_.spots.size()) - last.first;
  }

  std::uint32_t offset(const char* at) const noexcept {
    return static_cast<std::uint32_t>(at - file_.text);
  }
  std::uint32_t column(const char* at) const noexcept {
    return static_cast<std::uint32_t>(at - start_) + 1;
  }
  SourcePos here(std::string_view part) const noexcept { return {number_, column(part.data())}; }

  IniFile& file_;
  Report& report_;
  const char* start_ = nullptr;  ///< start of the line
  std::uint32_t number_ = 0;     ///< number of the line
};

/// The encoding of a text. UTF-16 is recognized by its mark, or by the NULs in every second byte of
/// ASCII text.
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

/// Returns the length of the UTF-8 character at `at`, or 0 if there is none.
std::size_t character_at(std::string_view text, std::size_t at) noexcept {
  if (static_cast<unsigned char>(text[at]) < 0x80) return 1;
  for (const std::size_t length : {2U, 3U, 4U}) {
    if (at + length <= text.size() && is_utf8(text.substr(at, length))) return length;
  }
  return 0;
}

/// Reports once that texts which are not UTF-8 are read as Windows-1252, because this encoding is
/// only likely.
void report_assumed_encoding(std::string_view text, Report& report) {
  if (is_utf8(text)) return;
  SourcePos pos{1, 1};
  std::size_t start = 0;
  std::size_t at = 0;
  for (std::size_t length = 1; (length = character_at(text, at)) != 0; at += length) {
    const bool pair = text[at] == '\r' && text.substr(at + 1).starts_with('\n');
    if (pair || (text[at] != '\n' && text[at] != '\r')) continue;
    ++pos.line;
    start = at + 1;
  }
  pos.column = static_cast<std::uint32_t>(at - start) + 1;
  report.note(pos, "encoding-assumed", "byte ", Hex{static_cast<unsigned char>(text[at]), 2},
              " is not UTF-8; texts with such bytes were read as Windows-1252");
}

}  // namespace

IniEntry IniSpot::entry_in(const char* text) const noexcept {
  const auto indent = static_cast<std::uint32_t>(text + key - line_in(text));
  return {.key = key_in(text),
          .value = value_in(text),
          .line = line,
          .key_column = indent + 1,
          .value_column = pos_in(text).column};
}

IniFile read_ini(std::string_view text, Report& report) {
  IniFile file;
  const auto encoding = encoding_of(text);
  if (encoding != Encoding::bytes) {
    report.warning({1, 1}, "utf-16",
                   "the file is UTF-16, but CiA 306 requires ASCII; the text was converted");
    file.recoded =
        std::make_unique<std::string>(utf16_to_utf8(text, encoding == Encoding::utf16_be));
    text = *file.recoded;
  }
  if (text.starts_with("\xEF\xBB\xBF")) {
    report.note({1, 1}, "byte-order-mark",
                "the file starts with a byte order mark; it was skipped");
    text.remove_prefix(3);
  }
  report_assumed_encoding(text, report);
  Reader{file, report}.read(text);
  return file;
}

}  // namespace takt
