#include "eds_parser/read/compact.hpp"

#include <algorithm>
#include <bitset>
#include <string>
#include <utility>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

SubObject* find_sub(Object& object, unsigned sub) noexcept {
  const auto it = std::ranges::lower_bound(object.subs, sub, {}, &SubObject::sub);
  return it != object.subs.end() && it->sub == sub ? &*it : nullptr;
}

void apply_entry(SubObject& sub, ObjectKey key, CompactList list, const IniEntry& entry,
                 ValueReader& values) {
  switch (list) {
    case CompactList::names:
      sub.name = to_utf8(entry.value);
      return;
    case CompactList::denotations:
      sub.denotation = to_utf8(entry.value);
      return;
    case CompactList::values:
      sub.parameter_text = to_utf8(entry.value);
      sub.parameter_pos = entry.pos();
      sub.parameter_value = values.read(
          entry.value, sub.type,
          {.key = key, .what = "Value", .pos = entry.pos(), .unreadable = Severity::error});
      return;
  }
}

std::string name_of(CompactList list) {
  return list == CompactList::names ? "Name" : list == CompactList::values ? "Value" : "Denotation";
}

}  // namespace

SubObject count_sub(const Object& object, std::uint8_t count) {
  SubObject sub;
  sub.name = "NrOfObjects";
  sub.type = DataType::unsigned8;
  sub.type_code = 0x0005;
  sub.access = Access::ro;
  sub.default_value = std::uint64_t{count};
  sub.default_text = std::to_string(count);
  sub.pos = object.pos;
  sub.default_pos = object.pos;
  return sub;
}

void expand_compact_subs(Object& object, const SubObject& pattern, std::uint8_t count) {
  std::vector<SubObject> described = std::move(object.subs);
  object.subs.clear();
  object.subs.reserve(std::max<std::size_t>(count + 1U, described.size()));
  auto next = described.begin();
  for (unsigned sub = 0; sub <= 0xFF; ++sub) {
    if (next != described.end() && next->sub == sub) {
      object.subs.push_back(std::move(*next++));
    } else if (sub == 0) {
      object.subs.push_back(count_sub(object, count));
    } else if (sub <= count) {
      object.subs.push_back(pattern);
      object.subs.back().sub = static_cast<std::uint8_t>(sub);
      object.subs.back().name += std::to_string(sub);
    }
  }
}

void merge_objects(std::vector<Object>& objects, std::vector<Object> made) {
  std::ranges::sort(made, {}, &Object::index);
  auto from = objects.size();
  auto to = from + made.size();
  objects.resize(to);
  while (!made.empty()) {
    if (from != 0 && objects[from - 1].index > made.back().index) {
      objects[--to] = std::move(objects[--from]);
    } else {
      objects[--to] = std::move(made.back());
      made.pop_back();
    }
  }
}

void apply_compact_list(Object& object, CompactList list, const IniEntries& entries,
                        ValueReader& values, Report& report) {
  std::bitset<256> applied;
  std::optional<IniEntry> count;
  for (const auto& entry : entries) {
    if (same_word(entry.key, "nrofentries")) {
      if (!count) count = entry;
      continue;
    }
    const auto number = entry_number(entry.key);
    auto* sub = number ? find_sub(object, *number) : nullptr;
    if (sub == nullptr) {
      report.warning(entry.key_pos(), "unknown-sub-object", "object ", Hex{object.index},
                     " has no sub-object ", Quoted{entry.key},
                     " (decimal); the entry was left out");
      continue;
    }
    if (applied[sub->sub]) {
      report.warning(entry.key_pos(), "duplicate-key", "sub-object ",
                     ObjectKey{object.index, sub->sub},
                     " is listed again; the first entry applies");
      continue;
    }
    applied.set(sub->sub);
    apply_entry(*sub, {object.index, sub->sub}, list, entry, values);
  }
  if (!count) return;
  check_entry_count(*count, numbered_entries(entries), hex(object.index).substr(2) + name_of(list),
                    report);
}

}  // namespace takt
