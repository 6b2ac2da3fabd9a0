#include "eds_parser/modules.hpp"

#include <algorithm>
#include <tuple>

#include "eds_parser/number.hpp"
#include "eds_parser/text.hpp"

namespace takt {
namespace {

constexpr std::size_t most_modules = 254;

/// `Count=n`: n sub-indices a module. `Count=0;b`: b bits a module.
struct Count {
  unsigned subs = 0;
  unsigned bits = 0;
};

unsigned small(std::string_view text, unsigned highest) noexcept {
  const auto number = parse_number(trim(text));
  const bool good = number && !number->negative && !number->relative();
  return good ? static_cast<unsigned>(std::min<std::uint64_t>(number->magnitude, highest)) : 0;
}

Count read_count(std::string_view text) noexcept {
  const auto separator = text.find(';');
  Count count{.subs = small(text.substr(0, separator), 254)};
  if (separator != std::string_view::npos) count.bits = small(text.substr(separator + 1), 64);
  return count;
}

Object& object_of(ObjectDictionary& dictionary, std::uint16_t index, const SubObject& pattern) {
  const auto at = std::ranges::lower_bound(dictionary.objects, index, {}, &Object::index);
  if (at != dictionary.objects.end() && at->index == index) return *at;
  Object object;
  object.index = index;
  object.name = pattern.name;
  object.type = ObjectType::array;
  object.list = ObjectList::optional;
  object.pos = pattern.pos;
  SubObject first;
  first.name = "NrOfObjects";
  first.type = DataType::unsigned8;
  first.type_code = 0x0005;
  first.access = Access::ro;
  first.pos = pattern.pos;
  first.default_pos = pattern.pos;
  object.subs.push_back(std::move(first));
  return *dictionary.objects.insert(at, std::move(object));
}

void add_sub(Object& object, const SubObject& pattern, unsigned sub) {
  const auto at = std::ranges::lower_bound(object.subs, sub, {}, &SubObject::sub);
  if (at != object.subs.end() && at->sub == sub) return;
  auto made = pattern;
  made.sub = static_cast<std::uint8_t>(sub);
  made.name += std::to_string(sub);
  object.subs.insert(at, std::move(made));
  auto& count = object.subs.front();
  if (count.sub != 0) return;
  count.default_value = std::uint64_t{object.subs.back().sub};
  count.default_text = std::to_string(object.subs.back().sub);
}

}  // namespace

void ModuleSections::add(const SectionName& name, std::uint32_t section) {
  constexpr std::string_view fixed = "Fixed";
  constexpr std::string_view extension = "SubExt";
  const bool is_fixed = fold(name.module_part.front()) == 'f';
  const auto skip = is_fixed ? fixed.size() : extension.size();
  if (fold(name.module_part.front()) != 'f' && fold(name.module_part.front()) != 's') return;
  if (name.module_part.size() <= skip) return;
  const auto object = classify_section(name.module_part.substr(skip));
  const bool usable =
      object.kind == SectionKind::object || (is_fixed && object.kind == SectionKind::sub_object);
  if (!usable) return;  // the lists [MxFixedObjects], [MxSubExtends]: the sections are the truth
  sections_.push_back({.module = name.module,
                       .part = is_fixed ? Part::fixed : Part::extension,
                       .object = ObjectSection::of(object, section)});
}

void ModuleSections::expand(ObjectDictionary& dictionary, ObjectReader& reader, Report& report) {
  if (connected_ == nullptr) return;
  const auto order = [](const ModuleSection& section) { return section.order(); };
  std::ranges::stable_sort(sections_, {}, order);
  const auto repeated = std::ranges::unique(sections_, {}, order);
  sections_.erase(repeated.begin(), repeated.end());
  std::vector<bool> seen(65536);
  for (const auto type : connected_types(report)) {
    if (!seen[type]) add_fixed(type, dictionary, reader);
    seen[type] = true;
    for (const auto& section : sections_of(type, Part::extension)) {
      if (extend(section, dictionary, reader)) continue;
      report.error(connected_->pos, "too-many-sub-objects",
                   "the connected modules need too many sub-objects; the rest was left out");
      return;
    }
  }
}

std::vector<std::uint16_t> ModuleSections::connected_types(Report& report) const {
  std::vector<std::uint16_t> types;
  for (const auto& entry : file_.entries(*connected_)) {
    if (same_word(entry.key, "nrofentries") || entry.value.empty()) continue;
    const auto type = static_cast<std::uint16_t>(small(entry.value, 0xFFFF));
    const bool known =
        !sections_of(type, Part::fixed).empty() || !sections_of(type, Part::extension).empty();
    if (types.size() == most_modules) {
      report.error(entry.pos(), "too-many-modules", "more than 254 modules; the rest is left out");
      break;
    }
    if (known) {
      types.push_back(type);
    } else if (report.wants("unknown-module")) {
      report.warning(entry.pos(), "unknown-module",
                     "module type " + quoted(entry.value) +
                         " brings no objects: there is no [Mx...] section of it");
    }
  }
  return types;
}

std::span<const ModuleSections::ModuleSection> ModuleSections::sections_of(std::uint16_t module,
                                                                           Part part) const {
  const auto key = [](const ModuleSection& section) {
    return std::tuple{section.module, section.part};
  };
  const auto found = std::ranges::equal_range(sections_, std::tuple{module, part}, {}, key);
  return {found.begin(), found.end()};
}

void ModuleSections::add_fixed(std::uint16_t module, ObjectDictionary& dictionary,
                               ObjectReader& reader) {
  const auto all = sections_of(module, Part::fixed);
  std::vector<ObjectSection> group;
  for (std::size_t at = 0; at < all.size(); ++at) {
    group.push_back(all[at].object);
    const auto index = all[at].object.index();
    if (at + 1 < all.size() && all[at + 1].object.index() == index) continue;
    if (dictionary.find(index) == nullptr) {
      auto object = reader.read(group);
      object.list =
          index >= 0x2000 && index < 0x6000 ? ObjectList::manufacturer : ObjectList::optional;
      const auto place = std::ranges::lower_bound(dictionary.objects, index, {}, &Object::index);
      dictionary.objects.insert(place, std::move(object));
    }
    group.clear();
  }
}

/// False: the budget is used up.
bool ModuleSections::extend(const ModuleSection& section, ObjectDictionary& dictionary,
                            ObjectReader& reader) {
  const auto& source = file_.sections[section.object.section];
  const auto extension = reader.read_extension(source, section.object.index());
  const auto count = read_count(extension.count);
  const unsigned last_sub = extension.last_sub == 0 ? 254 : extension.last_sub;
  if (!budget_.take(count.subs + 1U)) return false;
  auto& fill = fill_of(section.object.index());
  const auto next_sub = [&] {
    fill.bits_used = 0;
    if (fill.sub == last_sub && extension.last_sub != 0) {
      fill.sub = 0;
      ++fill.index;
    }
    if (fill.sub == 254) return;
    add_sub(object_of(dictionary, fill.index, extension.pattern), extension.pattern, ++fill.sub);
  };
  for (unsigned i = 0; i < count.subs; ++i) next_sub();
  if (count.bits == 0) return true;
  const unsigned width = std::max(bit_width(extension.pattern.type), 1U);
  if (fill.bits_used == 0 || fill.bits_used + count.bits > width) next_sub();
  fill.bits_used += count.bits;
  return true;
}

ModuleSections::Fill& ModuleSections::fill_of(std::uint16_t index) {
  const auto at = std::ranges::lower_bound(fills_, index, {}, &Fill::first_index);
  if (at != fills_.end() && at->first_index == index) return *at;
  return *fills_.insert(at, Fill{.first_index = index, .index = index});
}

}  // namespace takt
