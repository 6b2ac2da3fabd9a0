#include "eds_parser/ini/eds_lists.hpp"

#include <algorithm>

#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

constexpr std::uint32_t longest_list = 0xFFFF;

std::optional<std::uint32_t> small_number(std::string_view text) noexcept {
  const auto number = parse_number(text);
  if (!number || !number->is_within(longest_list)) return std::nullopt;
  return static_cast<std::uint32_t>(number->magnitude);
}

/// Returns true if the key is the word followed by a decimal number.
bool is_numbered(std::string_view key, std::string_view lower_word) noexcept {
  return has_prefix(key, lower_word) && entry_number(key.substr(lower_word.size())).has_value();
}

}  // namespace

bool is_count_key(std::string_view key) noexcept {
  constexpr std::string_view wanted = "supportedobjects";
  std::size_t at = 0;
  for (const char c : key) {
    if (is_blank(c)) continue;
    if (at == wanted.size() || fold(c) != wanted[at]) return false;
    ++at;
  }
  return at == wanted.size();
}

std::optional<std::uint32_t> entry_number(std::string_view key) noexcept {
  if (key.empty() || key.find_first_not_of("0123456789") != std::string_view::npos) {
    return std::nullopt;
  }
  key.remove_prefix(std::min(key.find_first_not_of('0'), key.size() - 1));
  return small_number(key);
}

std::size_t numbered_entries(const IniEntries& entries, std::string_view lower_word) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(
      entries, [&](const IniEntry& entry) { return is_numbered(entry.key, lower_word); }));
}

std::vector<IniEntry> read_numbered_list(const IniEntries& entries, std::string_view section,
                                         std::string_view lower_count, Report& report,
                                         std::string_view lower_word) {
  std::vector<IniEntry> numbered;
  std::optional<IniEntry> count;
  for (const auto& entry : entries) {
    if (same_word(entry.key, lower_count)) {
      if (!count) count = entry;
    } else if (is_numbered(entry.key, lower_word)) {
      numbered.push_back(entry);
    } else {
      report_unknown_key(entry, section, report);
    }
  }
  if (count) check_entry_count(*count, numbered.size(), section, report);
  return numbered;
}

bool is_mandatory(std::uint16_t index) noexcept {
  return index == 0x1000 || index == 0x1001 || index == 0x1018;
}

ObjectLists::ObjectLists(const IndexSet& described, Report& report)
    : described_{described}, report_{report}, membership_(65536, ObjectList::unlisted) {}

void ObjectLists::read(ObjectList list, const IniSection& section, const IniEntries& entries) {
  any_ = true;
  std::optional<IniEntry> count;
  std::uint32_t found = 0;
  std::uint32_t highest = 0;
  for (const auto& entry : entries) {
    if (is_count_key(entry.key)) {
      if (!count) count = entry;
      if (entry.key.find_first_of(" \t") == std::string_view::npos) continue;
      report_.warning(entry.key_pos(), "blank-in-key", "blank inside the key ", Quoted{entry.key},
                      "; read as SupportedObjects, other tools lose the whole list");
    } else if (const auto number = entry_number(entry.key)) {
      ++found;
      highest = std::max(highest, *number);
      add(list, entry);
    } else {
      report_.warning(entry.key_pos(), "unknown-key", "key ", Quoted{entry.key}, " of [",
                      Utf8{section.name},
                      "] is neither SupportedObjects nor a decimal number; it was left out");
    }
  }
  const auto declared = count ? small_number(count->value) : std::nullopt;
  const auto pos = count ? count->pos() : section.pos;
  if (!declared) {
    report_.warning(pos, "list-count-missing", "[", Utf8{section.name},
                    "] has no SupportedObjects");
  } else if (*declared != found) {
    report_.warning(pos, "list-count-wrong", "SupportedObjects is ", *declared,
                    ", but the list has ", found, " entries; all of them were read");
  }
  if (found != 0 && highest > found) {
    report_.warning(pos, "list-numbers-gap", "the entries of [", Utf8{section.name},
                    "] are not numbered 1 to ", found, "; all of them were read");
  }
}

void ObjectLists::add(ObjectList list, const IniEntry& entry) {
  if (entry.value.empty()) return;
  const auto number = small_number(entry.value);
  if (!number) {
    report_.warning(entry.pos(), "number-unreadable", Quoted{entry.value},
                    " is not the index of an object; the entry was left out");
    return;
  }
  const auto index = read_index(entry, static_cast<std::uint16_t>(*number));
  check_place(list, index, entry);
  if (!described_[index]) {
    report_.warning(entry.pos(), "listed-without-section", "object ", Hex{index},
                    " is listed but has no section [", hex(index).substr(2),
                    "]; it does not exist in this file");
    return;
  }
  if (membership_[index] != ObjectList::unlisted) {
    report_.warning(entry.pos(), "listed-twice", "object ", Hex{index}, " is listed twice");
    return;
  }
  membership_[index] = list;
}

/// Returns the index of an entry. An index without 0x, such as `2001`, is read as hexadecimal if
/// only that object exists.
std::uint16_t ObjectLists::read_index(const IniEntry& entry, std::uint16_t decimal) {
  const auto text = without_comment(entry.value);
  const auto index = hex_digits(text);
  const bool clear = !described_[decimal] && index && text.size() <= 4 && described_[*index];
  if (!clear) return decimal;
  report_.warning(entry.pos(), "hex-without-prefix", "list entry ", Quoted{entry.value},
                  " was read as ", Hex{*index}, "; write 0x in front");
  return static_cast<std::uint16_t>(*index);
}

void ObjectLists::check_place(ObjectList list, std::uint16_t index, const IniEntry& entry) {
  const bool manufacturer = index >= 0x2000 && index < 0x6000;
  if (manufacturer == (list == ObjectList::manufacturer)) return;
  report_.warning(entry.pos(), "wrong-list", "object ", Hex{index}, " belongs in [",
                  manufacturer          ? "ManufacturerObjects"
                  : is_mandatory(index) ? "MandatoryObjects"
                                        : "OptionalObjects",
                  ']');
}

void ObjectLists::report_unlisted(const Object& object) const {
  if (!any_ || membership_[object.index] != ObjectList::unlisted || object.index < 0x1000) return;
  report_.warning(object.pos, "object-not-listed", "object ", Hex{object.index},
                  " is in none of the object lists; it was read, other tools drop it");
}

}  // namespace takt
