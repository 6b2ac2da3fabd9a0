#include "eds_parser/ini/decimal_subs.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

constexpr std::size_t index_digits = 4;
constexpr std::size_t sub_at = index_digits + 3;
constexpr std::uint32_t last_sub = 254;

/// Returns the text after `xxxxsub`. The result is empty if the name has another form.
std::string_view sub_text(std::string_view name) noexcept {
  if (name.size() <= sub_at || !has_prefix(name.substr(index_digits), "sub")) return {};
  return hex_digits(name.substr(0, index_digits)) ? name.substr(sub_at) : std::string_view{};
}

std::optional<std::uint32_t> decimal_sub(const IniSection& section) noexcept {
  const auto sub = entry_number(sub_text(section.name));
  return sub && *sub <= last_sub ? sub : std::nullopt;
}

/// Returns true for a sub-index of three digits, which can only be decimal.
bool is_beyond_ff(const IniSection& section) noexcept {
  const auto& name = section.name;
  return name.size() == sub_at + 3 && name[sub_at] != '0' && decimal_sub(section).has_value();
}

/// Returns the DefaultValue of sub 0, or std::nullopt if it is no number or missing.
std::optional<std::uint64_t> default_value(const IniEntries& entries) noexcept {
  for (const IniEntry& entry : entries) {
    if (classify_key(entry.key) != Keyword::default_value) continue;
    const auto number = parse_number(entry.value);
    return number ? std::optional{number->magnitude} : std::nullopt;
  }
  return std::nullopt;
}

/// The sections of the sub-objects of one index, in the order of the file.
struct Subs {
  std::vector<IniSection*> sections;
  std::set<std::uint32_t> numbers;  ///< sub-indices in decimal, without sub 0
  std::optional<std::uint64_t> declared_highest;
  bool all_decimal = true;
  bool beyond_ff = false;

  void add(IniSection& section, const IniFile& file) {
    const auto sub = decimal_sub(section);
    sections.push_back(&section);
    all_decimal = all_decimal && sub.has_value();
    beyond_ff = beyond_ff || is_beyond_ff(section);
    if (sub == 0U) declared_highest = default_value(file.entries(section));
    if (sub.value_or(0) != 0) numbers.insert(*sub);
  }
  bool is_decimal() const noexcept { return all_decimal && (beyond_ff || shows_decimal()); }

 private:
  /// Returns true if the numbers are plausible only in decimal: in hexadecimal they would have a
  /// gap from 9 to 10, or would not end at the number that sub 0 states.
  bool shows_decimal() const noexcept {
    if (numbers.empty() || *numbers.rbegin() < 10) return false;
    return numbers.size() == *numbers.rbegin() || declared_highest == *numbers.rbegin();
  }
};

}  // namespace

void mark_decimal_subs(IniFile& file, Report& report) {
  if (std::ranges::none_of(file.sections, is_beyond_ff)) return;
  std::map<std::string, Subs> objects;
  for (auto& section : file.sections) {
    if (sub_text(section.name).empty()) continue;
    std::string index{section.name.substr(0, index_digits)};
    std::ranges::transform(index, index.begin(), fold);
    objects[std::move(index)].add(section, file);
  }
  for (const auto& [index, subs] : objects) {
    if (!subs.is_decimal()) continue;
    for (auto* section : subs.sections) section->has_decimal_sub = true;
    report.warning(subs.sections.front()->pos, "decimal-sub-index", "the sub-indices of [",
                   subs.sections.front()->name.substr(0, index_digits), "] were read as decimal, ",
                   subs.beyond_ff ? "because some exceed FF" : "as in other sections of the file",
                   "; CiA 306 writes sub-indices in hexadecimal, other tools read sub10 as 16");
  }
}

}  // namespace takt
