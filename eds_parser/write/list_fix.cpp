#include "eds_parser/write/list_fix.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {
namespace {

constexpr std::array<SectionKind, 3> kinds{SectionKind::mandatory_objects,
                                           SectionKind::optional_objects,
                                           SectionKind::manufacturer_objects};

bool is_number(std::string_view key) {
  return !key.empty() && std::ranges::all_of(key, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

SectionKind ListFix::kind_of(std::uint16_t index) {
  const bool manufacturer = index >= 0x2000 && index < 0x6000;
  if (is_mandatory(index)) return kinds[0];
  return manufacturer ? kinds[2] : kinds[1];
}

bool ListFix::move(const IniEntry& entry) {
  const auto number = parse_number(without_comment(entry.value));
  if (!number || number->magnitude > 0xFFFF) return false;
  const auto index = static_cast<std::uint16_t>(number->magnitude);
  // A later pass moves the entry once its 0x has been added.
  if (!number->hex && sections_.object(index) == nullptr) return false;
  drop(entry.line);
  add(index);
  return true;
}

void ListFix::remove_line(const IniEntry& entry) {
  const auto key = static_cast<std::size_t>(entry.key.data() - text_.data());
  const std::size_t first = key - (entry.key_column - 1);
  std::size_t end = std::min(text_.find_first_of("\r\n", key), text_.size());
  if (text_.substr(end).starts_with("\r\n")) ++end;
  if (end < text_.size()) ++end;
  edits_.replace(text_.substr(first, end - first), "");
}

/// Returns whether one of the lines belongs to the section. A finding on a list is at its name or
/// at one of its entries.
bool ListFix::within(const IniSection& section, const std::set<std::uint32_t>& lines) const {
  if (lines.contains(section.pos.line)) return true;
  return std::ranges::any_of(file_.entries(section),
                             [&](const IniEntry& entry) { return lines.contains(entry.line); });
}

void ListFix::create(SectionKind kind, const std::vector<std::uint16_t>& more) {
  constexpr std::array<std::string_view, 3> names{"MandatoryObjects", "OptionalObjects",
                                                  "ManufacturerObjects"};
  const auto at = static_cast<std::size_t>(std::ranges::find(kinds, kind) - kinds.begin());
  edits_.append_line("");
  edits_.append_line('[' + std::string{names[at]} + ']');
  edits_.append_line("SupportedObjects=" + std::to_string(more.size()));
  std::size_t number = 0;
  for (const std::uint16_t index : more) {
    edits_.append_line(std::to_string(++number) + '=' + hex(index));
  }
}

void ListFix::set_count(const IniSection& section, std::size_t number) {
  for (const IniEntry& entry : file_.entries(section)) {
    if (!is_count_key(entry.key)) continue;
    touched_.insert(entry.line);
    const std::string_view bare = without_comment(entry.value);
    const auto declared = parse_number(bare);
    if (declared && declared->magnitude == number && declared->quirks == 0) return;
    if (bare.empty()) {
      const auto at = static_cast<std::size_t>(entry.value.data() - text_.data());
      return edits_.replace(text_.substr(at, 0), std::to_string(number));
    }
    return edits_.replace(bare, std::to_string(number));
  }
  edits_.insert_line_after(section.name, "SupportedObjects=" + std::to_string(number));
}

void ListFix::mend(const IniSection& section, const std::vector<std::uint16_t>& more) {
  const auto entries = file_.entries(section);
  const bool gone = within(section, dropped_);
  const bool renumber = gone || within(section, renumbered_);
  std::string_view last = section.name;
  std::size_t number = 0;
  for (const IniEntry& entry : entries) {
    if (is_number(entry.key) && dropped_.contains(entry.line)) {
      remove_line(entry);
      touched_.insert(entry.line);
      continue;
    }
    if (is_number(entry.key) && ++number != 0 && renumber && entry.key != std::to_string(number)) {
      edits_.replace(entry.key, std::to_string(number));
      touched_.insert(entry.line);
    }
    last = entry.value.empty() ? entry.key : entry.value;
  }
  for (const std::uint16_t index : more) {
    edits_.insert_line_after(last, std::to_string(++number) + '=' + hex(index));
  }
  if (gone || !more.empty() || within(section, counted_)) set_count(section, number);
}

void ListFix::run() {
  for (const SectionKind kind : kinds) {
    std::vector<std::uint16_t> more;
    for (const std::uint16_t index : added_) {
      if (kind_of(index) == kind) more.push_back(index);
    }
    if (const IniSection* section = sections_.other(kind)) {
      mend(*section, more);
    } else if (!more.empty()) {
      create(kind, more);
    }
  }
}

}  // namespace takt
