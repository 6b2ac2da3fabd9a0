#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// One `key=value`; both are trimmed, the value still has its inline comment.
struct IniEntry {
  std::string_view key;
  std::string_view value;
  std::uint32_t line = 0;
  std::uint32_t key_column = 0;
  std::uint32_t value_column = 0;

  SourcePos pos() const noexcept { return {line, value_column}; }
  SourcePos key_pos() const noexcept { return {line, key_column}; }
};

struct IniSection {
  std::string_view name;
  SourcePos pos;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A file of sections, as EDS, DCF and CPJ are. Views point into the text given to read_ini, or
/// into `recoded` where that was UTF-16. CiA 306, 4.2.
struct IniFile {
  std::vector<IniSection> sections;  ///< in order of the file, duplicates included
  std::vector<IniEntry> all_entries;
  std::unique_ptr<std::string> recoded;

  std::span<const IniEntry> entries(const IniSection& section) const noexcept {
    return std::span{all_entries}.subspan(section.first, section.count);
  }
};

/// Splits a text into sections and entries. Line ends LF, CR LF, CR, also mixed; UTF-8 with or
/// without mark, any one-byte page, UTF-16 with mark. Lines that are neither give a finding.
/// `text` must outlive the result. Time and memory are proportional to the text.
IniFile read_ini(std::string_view text, Report& report);

}  // namespace takt
