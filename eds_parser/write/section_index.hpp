#pragma once
#include <map>
#include <optional>
#include <string_view>

#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Finds the sections of a file by the objects that they describe. If a section is repeated, the
/// first one counts, as in the reader.
class SectionIndex {
 public:
  explicit SectionIndex(const IniFile& file);

  /// Each of these functions returns nullptr if the file has no such section.
  const IniSection* object(std::uint16_t index) const noexcept;
  const IniSection* sub_object(ObjectKey key) const noexcept;
  const IniSection* value_list(std::uint16_t index) const noexcept;
  const IniSection* other(SectionKind kind) const noexcept;

  std::optional<IniEntry> entry(const IniSection& section,
                                std::string_view lower_key) const noexcept;
  /// Returns the entry of a value list for one sub-index. Its key may have leading zeros.
  std::optional<IniEntry> list_entry(const IniSection& list, std::uint8_t sub) const noexcept;
  /// Returns the text after which new lines of the section are inserted: its last entry, or its
  /// name.
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
