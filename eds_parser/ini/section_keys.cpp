#include "eds_parser/ini/section_keys.hpp"

#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {

SectionKeys::SectionKeys(const IniEntries& entries, Report& report) : report_{report} {
  for (const auto& entry : entries) slots_.push_back({entry});
}

const IniEntry* SectionKeys::get(std::string_view key) const {
  const IniEntry* found = nullptr;
  for (const auto& [entry, asked] : slots_) {
    if (!same_word(entry.key, key)) continue;
    asked = true;
    if (found == nullptr) {
      found = &entry;
    } else if (found->value != entry.value) {
      report_.warning(entry.pos(), "duplicate-key", "key ", Quoted{entry.key},
                      " is repeated with another value; the first one applies, ",
                      Quoted{found->value});
    }
  }
  return found;
}

std::string SectionKeys::text(std::string_view key) const {
  const auto* entry = get(key);
  return entry == nullptr ? std::string{} : to_utf8(entry->value);
}

void SectionKeys::flag(bool& out, std::string_view key, ValueReader& values) const {
  const auto* entry = get(key);
  if (entry != nullptr) out = values.read_flag(*entry);
}

void SectionKeys::report_unknown(std::string_view section,
                                 bool (*reserved)(std::string_view)) const {
  for (const auto& [entry, asked] : slots_) {
    if (!asked && !reserved(entry.key)) report_unknown_key(entry, section, report_);
  }
}

}  // namespace takt
