#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report/report.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {

/// One `key=value`. Both are trimmed; the value still contains its inline comment.
struct IniEntry {
  std::string_view key;
  std::string_view value;
  std::uint32_t line = 0;
  std::uint32_t key_column = 0;
  std::uint32_t value_column = 0;

  SourcePos pos() const noexcept { return {line, value_column}; }
  SourcePos key_pos() const noexcept { return {line, key_column}; }
};

/// The place of an entry as offsets into the text. A large file has so many entries that each byte
/// here counts. The other members of an IniEntry are derived from the text on demand.
struct IniSpot {
  std::uint32_t key = 0;
  std::uint32_t equals = 0;
  std::uint32_t end = 0;  ///< after the last character of the value
  std::uint32_t line = 0;

  std::string_view key_in(const char* text) const noexcept {
    const char* last = text + equals;
    while (last != text + key && is_blank(last[-1])) --last;
    return {text + key, last};
  }
  std::string_view value_in(const char* text) const noexcept {
    const char* first = text + equals + 1;
    while (first < text + end && is_blank(*first)) ++first;
    return {first, text + end};
  }
  SourcePos pos_in(const char* text) const noexcept {
    const auto column = value_in(text).data() - line_in(text);
    return {line, static_cast<std::uint32_t>(column) + 1};
  }
  IniEntry entry_in(const char* text) const noexcept;

 private:
  /// Returns the start of the line, which may begin with blanks before the key.
  const char* line_in(const char* text) const noexcept {
    const char* first = text + key;
    while (first != text && is_blank(first[-1]) && first[-1] != '\n' && first[-1] != '\r') --first;
    return first;
  }
};

/// The entries of a section in the order of the file.
class IniEntries {
 public:
  class Iterator {
   public:
    using value_type = IniEntry;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    Iterator(const char* text, const IniSpot* at) noexcept : text_{text}, at_{at} {}
    IniEntry operator*() const noexcept { return at_->entry_in(text_); }
    Iterator& operator++() noexcept {
      ++at_;
      return *this;
    }
    Iterator operator++(int) noexcept { return {text_, at_++}; }
    bool operator==(const Iterator& other) const noexcept { return at_ == other.at_; }

   private:
    const char* text_ = nullptr;
    const IniSpot* at_ = nullptr;
  };

  IniEntries() = default;
  IniEntries(const char* text, std::span<const IniSpot> spots) noexcept
      : text_{text}, spots_{spots} {}

  Iterator begin() const noexcept { return {text_, spots_.data()}; }
  Iterator end() const noexcept { return {text_, spots_.data() + spots_.size()}; }
  std::size_t size() const noexcept { return spots_.size(); }
  bool empty() const noexcept { return spots_.empty(); }
  std::span<const IniSpot> spots() const noexcept { return spots_; }
  IniEntry operator[](std::size_t at) const noexcept { return spots_[at].entry_in(text_); }
  IniEntry back() const noexcept { return spots_.back().entry_in(text_); }

 private:
  const char* text_ = nullptr;
  std::span<const IniSpot> spots_;
};

struct IniSection {
  std::string_view name;  ///< name in the text, between the brackets
  SourcePos pos;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool closed = true;            ///< The closing ] is present.
  bool has_decimal_sub = false;  ///< [2000sub128]; see mark_decimal_subs()

  /// Returns true if there are blanks around the name: [ 2000 ].
  bool padded() const noexcept {
    return name.data()[-1] != '[' || (closed && name.data()[name.size()] != ']');
  }
};

/// Returns the name of a section in brackets.
inline std::string to_string(const IniSection& section) {
  return concat('[', Utf8{section.name}, ']');
}

/// A file of sections, such as an EDS, DCF or CPJ. The views point into the text given to read_ini,
/// or into `recoded` if that text was UTF-16. CiA 306, 4.2.
struct IniFile {
  std::vector<IniSection> sections;  ///< in the order of the file, including duplicates
  std::vector<IniSpot> spots;
  std::unique_ptr<std::string> recoded;
  const char* text = nullptr;  ///< base of the offsets of the spots

  IniEntries entries(const IniSection& section) const noexcept {
    return {text, std::span{spots}.subspan(section.first, section.count)};
  }
};

/// Splits a text of less than 4 GB into sections and entries. Lines may end with LF, CR LF or CR,
/// also mixed. The text may be UTF-8 with or without a byte order mark, any one-byte code page, or
/// UTF-16 with a byte order mark. Every other line that is neither blank nor a comment gives a
/// finding. `text` must outlive the result. Time and memory are proportional to the length of the
/// text.
IniFile read_ini(std::string_view text, Report& report);

}  // namespace takt
