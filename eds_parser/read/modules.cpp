#include "eds_parser/read/modules.hpp"

#include <algorithm>
#include <map>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/read/compact.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

constexpr std::size_t most_modules = 254;

/// The values of `Count=n` (n sub-indices for each module) or `Count=0;b` (b bits for each module).
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

/// Returns true if the text holds valid numbers that are not too large.
bool brings_something(std::string_view text) noexcept {
  const auto separator = text.find(';');
  const auto subs = parse_number(trim(text.substr(0, separator)));
  if (!subs || !subs->is_within(254)) return false;
  if (separator == std::string_view::npos) return subs->magnitude != 0;
  const unsigned bits = small(text.substr(separator + 1), 65);
  return bits >= 1 && bits <= 64;
}

/// Returns an array without elements, for the extensions of modules.
Object extended_object(std::uint16_t index, const SubObject& pattern) {
  Object object;
  object.index = index;
  object.name = pattern.name;
  object.type = ObjectType::array;
  object.list = ObjectList::optional;
  object.pos = pattern.pos;
  object.subs.push_back(count_sub(object, 0));
  return object;
}

/// Adds a sub-object unless the file describes it already. Sub 0 is updated in both cases.
void add_sub(Object& object, const SubObject& pattern, unsigned sub) {
  const auto at = std::ranges::lower_bound(object.subs, sub, {}, &SubObject::sub);
  if (at == object.subs.end() || at->sub != sub) {
    auto made = pattern;
    made.sub = static_cast<std::uint8_t>(sub);
    made.name += std::to_string(sub);
    object.subs.insert(at, std::move(made));
  }
  auto& count = object.subs.front();
  if (count.sub != 0) return;
  const auto highest = object.subs.back().sub;
  const auto* stated =
      count.default_value ? std::get_if<std::uint64_t>(&*count.default_value) : nullptr;
  if (stated != nullptr && *stated >= highest) return;
  count.default_value = std::uint64_t{highest};
  count.default_text = std::to_string(highest);
}

}  // namespace

bool ModuleSections::add(const SectionName& name, std::uint32_t section) {
  constexpr std::string_view fixed = "Fixed";
  constexpr std::string_view extension = "SubExt";
  const char first = fold(name.module_part.front());
  const bool is_fixed = first == 'f';
  if (!is_fixed && first != 's') return true;  // [MxModuleInfo] and [MxComments] are not used.
  const auto rest = name.module_part.substr(is_fixed ? fixed.size() : extension.size());
  const Part part = is_fixed ? Part::fixed : Part::extension;
  if (same_word(rest, is_fixed ? "objects" : "ends")) {
    lists_.add_list(name.module, part, file_.sections[section]);
    return true;
  }
  const auto object = classify_section(rest);
  if (!(is_fixed ? is_of_object(object.kind) : object.kind == SectionKind::object)) return false;
  if (object.blank && !file_.sections[section].padded()) {
    report_blank_in_name(file_.sections[section], report_);
  }
  lists_.add_object(name.module, part, object.index, file_.sections[section]);
  indices_.insert(object.index);
  sections_.push_back(
      {.module = name.module, .part = part, .object = ObjectSection::of(object, section)});
  return true;
}

/// Adds the objects of the connected modules to a dictionary.
class ModuleSections::Expansion {
 public:
  Expansion(const ModuleSections& modules, ObjectDictionary& dictionary, ObjectReader& reader)
      : modules_{modules},
        file_{modules.file_},
        report_{modules.report_},
        dictionary_{dictionary},
        reader_{reader} {}

  void run() {
    dictionary_.connected_modules = modules_.connected_types();
    if (!add_modules()) {
      report_.error(
          modules_.connected_->pos, "too-many-sub-objects",
          "the connected modules need too many sub-objects; the remaining ones were left out");
    }
    for (const auto& fill : fills_) report_overlap(fill);
    std::vector<Object> made;
    made.reserve(made_.size());
    for (auto& [index, object] : made_) made.push_back(std::move(object));
    merge_objects(dictionary_.objects, std::move(made));
  }

 private:
  /// The progress of filling the sub-indices of an extended object.
  struct Fill {
    std::uint16_t first_index = 0;
    std::uint16_t index = 0;
    unsigned sub = 0;
    unsigned bits_used = 0;
    unsigned described = 0;  ///< highest sub-index that `index` had before the extension
  };

  /// Returns false if the budget is used up.
  bool add_modules() {
    std::vector<bool> seen(65536);
    for (const auto type : dictionary_.connected_modules) {
      if (!seen[type]) add_fixed(type);
      seen[type] = true;
      for (const auto& section : modules_.sections_of(type, Part::extension)) {
        if (!extend(section)) return false;
      }
    }
    return true;
  }

  void add_fixed(std::uint16_t module) {
    const auto all = modules_.sections_of(module, Part::fixed);
    std::vector<ObjectSection> group;
    for (std::size_t at = 0; at < all.size(); ++at) {
      group.push_back(all[at].object);
      const auto index = all[at].object.index();
      if (at + 1 < all.size() && all[at + 1].object.index() == index) continue;
      const bool is_new = dictionary_.find(index) == nullptr && !made_.contains(index);
      if (is_new && group.front().is_list()) {
        report_list_without_object(file_.sections[group.front().section], report_);
      } else if (is_new) {
        auto object = reader_.read(group);
        object.list =
            index >= 0x2000 && index < 0x6000 ? ObjectList::manufacturer : ObjectList::optional;
        made_.emplace(index, std::move(object));
      }
      group.clear();
    }
  }

  /// Returns the object from the file or from the modules so far, or nullptr.
  Object* find(std::uint16_t index) {
    const auto at = std::ranges::lower_bound(dictionary_.objects, index, {}, &Object::index);
    if (at != dictionary_.objects.end() && at->index == index) return &*at;
    const auto made = made_.find(index);
    return made == made_.end() ? nullptr : &made->second;
  }

  /// Returns false if the budget is used up.
  bool extend(const ModuleSection& section) {
    const auto [at, is_new] = extensions_.try_emplace(section.object.section);
    if (is_new) at->second = modules_.read_extension(section, reader_);
    const SubExtension& extension = at->second;
    const auto count = read_count(extension.count);
    if (!budget_.take(count.subs + 1U)) return false;
    auto& fill = fill_of(section.object.index());
    for (unsigned i = 0; i < count.subs; ++i) add_next(fill, extension);
    if (count.bits == 0) return true;
    const unsigned width = std::max(bit_width(extension.pattern.type), 1U);
    if (fill.bits_used == 0 || fill.bits_used + count.bits > width) add_next(fill, extension);
    fill.bits_used += count.bits;
    return true;
  }

  /// Adds the next sub-object of an extension, in the next object if this one is full.
  void add_next(Fill& fill, const SubExtension& extension) {
    fill.bits_used = 0;
    if (extension.last_sub != 0 && fill.sub == extension.last_sub) {
      report_overlap(fill);
      fill.sub = 0;
      fill.described = described_subs(++fill.index);
    }
    if (fill.sub == 254) return;
    auto* object = find(fill.index);
    if (object == nullptr) {
      object =
          &made_.emplace(fill.index, extended_object(fill.index, extension.pattern)).first->second;
    }
    add_sub(*object, extension.pattern, ++fill.sub);
  }

  Fill& fill_of(std::uint16_t index) {
    const auto at = std::ranges::lower_bound(fills_, index, {}, &Fill::first_index);
    if (at != fills_.end() && at->first_index == index) return *at;
    return *fills_.insert(
        at, Fill{.first_index = index, .index = index, .described = described_subs(index)});
  }

  /// Returns the highest sub-index that an object has before modules extend it.
  unsigned described_subs(std::uint16_t index) {
    const auto* object = find(index);
    if (object == nullptr) return 0;
    unsigned highest = 0;
    for (const auto& sub : object->subs) {
      if (sub.sub != 0xFF) highest = sub.sub;
    }
    return highest;
  }

  /// Warns if the file describes another number of sub-objects than the modules add. A DCF may
  /// describe the sub-objects of its modules by sections; the numbers are then equal. If they
  /// differ, some sections were meant for other sub-objects.
  void report_overlap(const Fill& fill) {
    if (fill.described == 0 || fill.sub == 0 || fill.described == fill.sub) return;
    report_.warning(find(fill.index)->pos, "module-sub-objects", "object ", Hex{fill.index},
                    " is described up to sub-index ", fill.described,
                    ", but the connected modules have ", fill.sub,
                    "; sub-objects of the same number were merged");
  }

  const ModuleSections& modules_;
  const IniFile& file_;
  Report& report_;
  ObjectDictionary& dictionary_;
  ObjectReader& reader_;
  std::map<std::uint32_t, SubExtension> extensions_;  ///< keys are section numbers
  std::vector<Fill> fills_;                           ///< in ascending order of first_index
  std::map<std::uint16_t, Object> made_;  ///< objects that the dictionary does not have yet
  ExpansionBudget budget_;
};

void ModuleSections::expand(ObjectDictionary& dictionary, ObjectReader& reader) {
  const auto order = [](const ModuleSection& section) { return section.order(); };
  std::ranges::stable_sort(sections_, {}, order);
  const auto repeated = std::ranges::unique(sections_, {}, order);
  sections_.erase(repeated.begin(), repeated.end());
  if (connected_ != nullptr) Expansion{*this, dictionary, reader}.run();
}

void ModuleSections::check(const ObjectDictionary& dictionary) {
  lists_.check(file_, dictionary.modules.size(), report_);
  ValueReader values{report_, dictionary.node_id};
  ObjectReader reader{file_, values, report_, BeyondBudget::shape};
  std::vector<ObjectSection> group;
  for (std::size_t at = 0; at < sections_.size(); ++at) {
    const auto& section = sections_[at];
    if (std::ranges::find(dictionary.connected_modules, section.module) !=
        dictionary.connected_modules.end()) {
      continue;
    }
    if (section.part == Part::extension) {
      read_extension(section, reader);
      continue;
    }
    group.push_back(section.object);
    const bool goes_on = at + 1 < sections_.size() && sections_[at + 1].part == Part::fixed &&
                         sections_[at + 1].module == section.module &&
                         sections_[at + 1].object.index() == section.object.index();
    if (goes_on) continue;
    if (!group.front().is_list()) reader.read(group);
    group.clear();
  }
}

/// Returns the entries of [ConnectedModules] by number, which is the order of the modules on the
/// device.
std::vector<ModuleSections::Slot> ModuleSections::slots() const {
  std::vector<Slot> slots;
  std::optional<IniEntry> count;
  for (const auto& entry : file_.entries(*connected_)) {
    if (same_word(entry.key, "nrofentries")) {
      if (!count) count = entry;
    } else if (const auto number = entry_number(entry.key)) {
      slots.push_back({*number, entry});
    } else {
      report_.warning(entry.key_pos(), "unknown-key", "key ", Quoted{entry.key},
                      " of [ConnectedModules] is neither NrOfEntries nor a decimal number; it was "
                      "left out");
    }
  }
  if (count && small(count->value, 0xFFFF'FFFF) != slots.size()) {
    report_.warning(count->pos(), "module-count", "NrOfEntries is ", Quoted{count->value},
                    ", but [ConnectedModules] has ", slots.size(),
                    " entries; all of them were read");
  }
  std::ranges::stable_sort(slots, {}, &Slot::number);
  const auto same = [this](const Slot& first, const Slot& second) {
    if (first.number != second.number) return false;
    report_.warning(second.entry.key_pos(), "duplicate-key", "module ", second.number,
                    " is connected again; the first entry applies");
    return true;
  };
  slots.erase(std::unique(slots.begin(), slots.end(), same), slots.end());
  return slots;
}

std::vector<std::uint16_t> ModuleSections::connected_types() const {
  std::vector<std::uint16_t> types;
  for (const auto& [number, entry] : slots()) {
    if (entry.value.empty()) continue;
    const auto type = static_cast<std::uint16_t>(small(entry.value, 0xFFFF));
    if (types.size() == most_modules) {
      report_.error(entry.pos(), "too-many-modules",
                    "more than 254 modules; the further ones were left out");
      break;
    }
    types.push_back(type);
    if (sections_of(type, Part::fixed).empty() && sections_of(type, Part::extension).empty()) {
      report_.warning(entry.pos(), "unknown-module", "module type ", Quoted{entry.value},
                      " adds no objects: the file has no [MxFixed...] or [MxSubExt...] section for "
                      "this type");
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

SubExtension ModuleSections::read_extension(const ModuleSection& section,
                                            ObjectReader& reader) const {
  const auto& source = file_.sections[section.object.section];
  SubExtension extension = reader.read_extension(source, section.object.index());
  if (!brings_something(extension.count)) {
    report_.warning(extension.count_pos, "number-unreadable", "Count of ", source, " is ",
                    Quoted{extension.count}, ", not a number of 1..254 or, for bits, as 0;2");
  }
  return extension;
}

}  // namespace takt
