#include "eds_parser/read/module_lists.hpp"

#include <optional>
#include <string>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/section_keys.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

/// Returns the name of a list: `M1FixedObjects`, `M1SubExtends`.
std::string list_name(std::uint16_t module, ModulePart part) {
  return 'M' + std::to_string(module) + (part == ModulePart::fixed ? "FixedObjects" : "SubExtends");
}

}  // namespace

void ModuleLists::set_supported(const IniSection& section) noexcept {
  if (supported_ == nullptr) supported_ = &section;
}

void ModuleLists::add_list(std::uint16_t module, ModulePart part, const IniSection& section) {
  lists_.push_back({module, part, &section});
}

void ModuleLists::add_object(std::uint16_t module, ModulePart part, std::uint16_t index,
                             const IniSection& section) {
  objects_.insert({module, part, index, &section});
}

void ModuleLists::check(const IniFile& file, std::size_t described, Report& report) const {
  check_supported(file, described, report);
  std::set<Object> listed;
  for (const List& list : lists_) check_list(list, file.entries(*list.section), listed, report);
  for (const Object& object : objects_) {
    if (listed.contains(object)) continue;
    report.warning(object.section->pos, "module-list", "section ", Quoted{object.section->name},
                   " is not named by an entry of [", list_name(object.module, object.part),
                   "]; it was read, other tools drop it");
  }
}

void ModuleLists::check_supported(const IniFile& file, std::size_t described,
                                  Report& report) const {
  if (supported_ == nullptr) return;
  const SectionKeys keys{file.entries(*supported_), report};
  const auto* count = keys.get("nrofentries");
  if (count != nullptr) check_entry_count(*count, described, "SupportedModules", report);
}

void ModuleLists::check_list(const List& list, const IniEntries& entries, std::set<Object>& listed,
                             Report& report) const {
  ValueReader values{report, std::nullopt};
  for (const auto& entry : read_numbered_list(entries, list.section->name, "nrofentries", report)) {
    const auto index = values.read_count(entry, 0xFFFF);
    if (!index) continue;
    const Object object{list.module, list.part, static_cast<std::uint16_t>(*index), list.section};
    listed.insert(object);
    if (objects_.contains(object)) continue;
    const std::string kind = list.part == ModulePart::fixed ? "Fixed" : "SubExt";
    report.warning(entry.pos(), "module-list", *list.section, " names object ", Hex{object.index},
                   ", but there is no [M", list.module, kind, hex(object.index).substr(2), ']');
  }
}

}  // namespace takt
