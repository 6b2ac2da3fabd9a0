#pragma once
#include <map>
#include <optional>
#include <string_view>

#include "eds_parser/eds_section.hpp"
#include "eds_parser/ini.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Finds the sections of a file by what they are about; of a repeated one the first counts, as it
/// does for the reader.
class SectionIndex {
 public:
  explicit SectionIndex(const IniFile& file);

  /// nullptr: the file has none.
  const IniSection* object(std::uint16_t index) const noexcept;
  const IniSection* sub_object(ObjectKey key) const noexcept;
  const IniSection* value_list(std::uint16_t index) const noexcept;
  const IniSection* other(SectionKind kind) const noexcept;

  std::optional<IniEntry> entry(const IniSection& section,
                                std::string_view lower_key) const noexcept;
  /// The entry of a value list for one sub-index, however many zeros its key starts with.
  std::optional<IniEntry> list_entry(const IniSection& list, std::uint8_t sub) const noexcept;
  /// Behind which a line is added to the section: its last entry, or its name.
  std::string_view last_line(const IniSection& section) const noexcept;

 private:
  struct Key {
    SectionKind kind;
    ObjectKey object;
    auto operator<=>(const Key&) const = default;
  };

  const IniSection* find(const Key& key) const noexcept;

  const IniFile& file_;
  std::map<Key, const IniSection*> sections_;
};

}  // namespace takt
