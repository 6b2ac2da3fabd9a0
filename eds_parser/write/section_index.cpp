#include "eds_parser/write/section_index.hpp"

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {

SectionIndex::SectionIndex(const IniFile& file) : file_{file} {
  for (const auto& section : file.sections) {
    const auto name = classify_section(section);
    const auto kind =
        name.kind == SectionKind::commissioning_two_m ? SectionKind::commissioning : name.kind;
    sections_.try_emplace({kind, {name.index, name.sub}}, &section);
  }
}

const IniSection* SectionIndex::find(const Key& key) const noexcept {
  const auto at = sections_.find(key);
  return at == sections_.end() ? nullptr : at->second;
}

const IniSection* SectionIndex::object(std::uint16_t index) const noexcept {
  return find({SectionKind::object, {index, 0}});
}

const IniSection* SectionIndex::sub_object(ObjectKey key) const noexcept {
  return find({SectionKind::sub_object, key});
}

const IniSection* SectionIndex::value_list(std::uint16_t index) const noexcept {
  return find({SectionKind::value_list, {index, 0}});
}

const IniSection* SectionIndex::other(SectionKind kind) const noexcept { return find({kind, {}}); }

std::optional<IniEntry> SectionIndex::entry(const IniSection& section,
                                            std::string_view lower_key) const noexcept {
  for (const auto& entry : file_.entries(section)) {
    if (same_word(entry.key, lower_key)) return entry;
  }
  return std::nullopt;
}

std::optional<IniEntry> SectionIndex::list_entry(const IniSection& list,
                                                 std::uint8_t sub) const noexcept {
  for (const auto& entry : file_.entries(list)) {
    if (entry_number(entry.key) == sub) return entry;
  }
  return std::nullopt;
}

std::string_view SectionIndex::last_line(const IniSection& section) const noexcept {
  const auto entries = file_.entries(section);
  if (entries.empty()) return section.name;
  const auto last = entries.back();
  return last.value.empty() ? last.key : last.value;
}

}  // namespace takt
