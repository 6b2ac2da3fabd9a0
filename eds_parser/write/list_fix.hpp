#pragma once
#include <cstdint>
#include <set>
#include <vector>

#include "eds_parser/ini.hpp"
#include "eds_parser/source.hpp"
#include "eds_parser/write/section_index.hpp"
#include "eds_parser/write/text_edits.hpp"

namespace takt {

/// Mends the three lists of objects: entries that repeat go, objects without an entry get one,
/// each stands in its list, numbers run from 1, the count is right.
class ListFix {
 public:
  /// `touched` receives the lines that are not to be edited any more.
  ListFix(std::string_view text, const IniFile& file, const SectionIndex& sections,
          TextEdits& edits, std::set<std::uint32_t>& touched)
      : text_{text}, file_{file}, sections_{sections}, edits_{edits}, touched_{touched} {}

  /// The entry on this line says what another one has said.
  void drop(std::uint32_t line) { dropped_.insert(line); }
  /// The object of this entry belongs into another list. False: it is not clear which object.
  bool move(const IniEntry& entry);
  /// No list has this object.
  void add(std::uint16_t index) { added_.insert(index); }
  /// The list whose count or name is on this line is wrong in its count, or in its numbers.
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
