#pragma once
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

using IndexSet = std::bitset<65536>;

/// Returns true if the key is `SupportedObjects`, with or without blanks inside.
bool is_count_key(std::string_view key) noexcept;
/// Returns the key of an entry of an object list or value list as a number. Such keys are always
/// decimal, and leading zeros do not matter.
std::optional<std::uint32_t> entry_number(std::string_view key) noexcept;
/// Counts the entries whose key is a number after `lower_word`, such as `Line12` after
/// `line`. NrOfEntries, Lines ... state this count.
std::size_t numbered_entries(const IniEntries& entries, std::string_view lower_word = {}) noexcept;
/// Returns the entries whose key is a number after `lower_word`. Reports other keys, and a wrong
/// count in the entry `lower_count`, such as `nrofentries`.
std::vector<IniEntry> read_numbered_list(const IniEntries& entries, std::string_view section,
                                         std::string_view lower_count, Report& report,
                                         std::string_view lower_word = {});
/// Returns true if the object belongs to [MandatoryObjects]. CiA 306, 4.6.3.1.
bool is_mandatory(std::uint16_t index) noexcept;

/// Compares [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects] with the sections of
/// the file. The sections decide which objects exist; the lists only say where an object belongs.
/// CiA 306, 4.6.3.1.
class ObjectLists {
 public:
  /// `described` holds the indices that have a section.
  ObjectLists(const IndexSet& described, Report& report);

  void read(ObjectList list, const IniSection& section, const IniEntries& entries);
  ObjectList list_of(std::uint16_t index) const noexcept { return membership_[index]; }
  /// Warns if no list names the object.
  void report_unlisted(const Object& object) const;
  bool any() const noexcept { return any_; }

 private:
  void add(ObjectList list, const IniEntry& entry);
  std::uint16_t read_index(const IniEntry& entry, std::uint16_t decimal);
  void check_place(ObjectList list, std::uint16_t index, const IniEntry& entry);

  const IndexSet& described_;
  Report& report_;
  std::vector<ObjectList> membership_;
  bool any_ = false;
};

}  // namespace takt
