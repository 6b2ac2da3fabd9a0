#pragma once
#include <cstdint>
#include <set>
#include <vector>

#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/write/section_index.hpp"
#include "eds_parser/write/text_edits.hpp"

namespace takt {

/// Mends the three lists of objects. It removes repeated entries, adds entries for objects that
/// have none, moves entries to the right list, numbers entries from 1, and corrects the counts.
class ListFix {
 public:
  /// `touched` receives the lines that later edits must not change.
  ListFix(std::string_view text, const IniFile& file, const SectionIndex& sections,
          TextEdits& edits, std::set<std::uint32_t>& touched)
      : text_{text}, file_{file}, sections_{sections}, edits_{edits}, touched_{touched} {}

  /// Notes that the entry on this line repeats another one.
  void drop(std::uint32_t line) { dropped_.insert(line); }
  /// Notes that the object of this entry belongs in another list. Returns false if the object is
  /// not clear.
  bool move(const IniEntry& entry);
  /// Notes that no list has this object.
  void add(std::uint16_t index) { added_.insert(index); }
  /// Notes that the count, or the numbering, of a list is wrong. The count or the name of the list
  /// is on this line.
  void count(std::uint32_t line) { counted_.insert(line); }
  void renumber(std::uint32_t line) { renumbered_.insert(line); }
  void run();

 private:
  void mend(const IniSection& section, const std::vector<std::uint16_t>& more);
  void create(SectionKind kind, const std::vector<std::uint16_t>& more);
  void set_count(const IniSection& section, std::size_t number);
  void remove_line(const IniEntry& entry);
  static SectionKind kind_of(std::uint16_t index);
  bool within(const IniSection& section, const std::set<std::uint32_t>& lines) const;

  std::string_view text_;
  const IniFile& file_;
  const SectionIndex& sections_;
  TextEdits& edits_;
  std::set<std::uint32_t>& touched_;
  std::set<std::uint32_t> dropped_;
  std::set<std::uint32_t> counted_;
  std::set<std::uint32_t> renumbered_;
  std::set<std::uint16_t> added_;
};

}  // namespace takt
