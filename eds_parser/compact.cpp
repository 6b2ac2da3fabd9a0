#include "eds_parser/compact.hpp"

#include <algorithm>
#include <string>

#include "eds_parser/number.hpp"
#include "eds_parser/text.hpp"

namespace takt {
namespace {

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
      sub.parameter_value = values.read(entry.value, sub.type, {key, "Value", entry.pos()});
      return;
  }
}

/// One PDO entry of a record made up by CompactPDO.
SubObject pdo_sub(std::uint8_t sub, std::string name, DataType type, std::uint64_t value) {
  SubObject made;
  made.sub = sub;
  made.name = std::move(name);
  made.type = type;
  made.type_code = static_cast<std::uint16_t>(type);
  made.access = Access::rw;
  made.default_value = value;
  made.default_text = std::to_string(value);
  return made;
}

/// Default COB-ID: the predefined connection set for PDO 1 to 4, else "does not exist".
SubObject cob_id_sub(std::uint16_t number, bool is_tpdo, std::optional<NodeId> node) {
  auto sub = pdo_sub(1, "COB-ID", DataType::unsigned32, 0x8000'0000);
  sub.default_text = "0x80000000";
  if (number > 4) return sub;
  const unsigned base = (is_tpdo ? 0x180U : 0x200U) + 0x100U * (number - 1U);
  sub.default_text = "$NODEID+" + hex(base, 3);
  sub.default_value.reset();
  if (node) sub.default_value = std::uint64_t{base} + node->value();
  return sub;
}

Object communication_record(std::uint16_t number, bool is_tpdo,
                            const ObjectDictionary& dictionary) {
  Object object;
  object.index = static_cast<std::uint16_t>((is_tpdo ? 0x1800 : 0x1400) + number - 1);
  object.name = (is_tpdo ? "TPDO " : "RPDO ") + std::to_string(number) + " communication";
  object.type = ObjectType::record;
  object.list = ObjectList::optional;
  const unsigned mask = dictionary.device.compact_pdo;
  std::vector<SubObject> subs;
  if ((mask & 0x01) != 0) subs.push_back(cob_id_sub(number, is_tpdo, dictionary.node_id));
  if ((mask & 0x02) != 0) {
    subs.push_back(pdo_sub(2, "Transmission type", DataType::unsigned8, 255));
  }
  if ((mask & 0x04) != 0) subs.push_back(pdo_sub(3, "Inhibit time", DataType::unsigned16, 0));
  if ((mask & 0x08) != 0) subs.push_back(pdo_sub(4, "Reserved", DataType::unsigned8, 0));
  if ((mask & 0x10) != 0) subs.push_back(pdo_sub(5, "Event timer", DataType::unsigned16, 0));
  if ((mask & 0x20) != 0) subs.push_back(pdo_sub(6, "SYNC start value", DataType::unsigned8, 0));
  const std::uint8_t highest = subs.empty() ? std::uint8_t{0} : subs.back().sub;
  object.subs.push_back(count_sub(object, highest));
  for (auto& sub : subs) object.subs.push_back(std::move(sub));
  return object;
}

Object mapping_record(std::uint16_t number, bool is_tpdo) {
  Object object;
  object.index = static_cast<std::uint16_t>((is_tpdo ? 0x1A00 : 0x1600) + number - 1);
  object.name = (is_tpdo ? "TPDO " : "RPDO ") + std::to_string(number) + " mapping";
  object.type = ObjectType::record;
  object.list = ObjectList::optional;
  object.subs.push_back(pdo_sub(0, "Number of mapped objects", DataType::unsigned8, 0));
  for (unsigned sub = 1; sub <= 64; ++sub) {
    object.subs.push_back(pdo_sub(static_cast<std::uint8_t>(sub),
                                  "Mapped object " + std::to_string(sub), DataType::unsigned32, 0));
  }
  return object;
}

void expand_direction(ObjectDictionary& dictionary, bool is_tpdo, std::uint16_t total) {
  const std::uint16_t first = is_tpdo ? 0x1800 : 0x1400;
  const auto described = static_cast<std::size_t>(
      std::ranges::count_if(dictionary.objects, [first](const Object& object) {
        return object.index >= first && object.index < first + 0x200;
      }));
  if (total > 512) total = 512;
  std::size_t missing = total > described ? total - described : 0;
  std::vector<Object> made;
  for (std::uint16_t number = 1; missing > 0 && number <= 512; ++number) {
    const auto index = static_cast<std::uint16_t>(first + number - 1);
    if (dictionary.find(index) != nullptr) continue;
    made.push_back(communication_record(number, is_tpdo, dictionary));
    if (dictionary.find(static_cast<std::uint16_t>(index + 0x200)) == nullptr) {
      made.push_back(mapping_record(number, is_tpdo));
    }
    --missing;
  }
  for (auto& object : made) dictionary.objects.push_back(std::move(object));
  std::ranges::stable_sort(dictionary.objects, {}, &Object::index);
}

}  // namespace

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

void apply_compact_list(Object& object, CompactList list, std::span<const IniEntry> entries,
                        ValueReader& values, Report& report) {
  for (const auto& entry : entries) {
    if (same_word(entry.key, "nrofentries")) continue;
    const auto number = parse_number(entry.key);
    auto* sub = number && !number->relative() && number->magnitude <= 0xFF
                    ? find_sub(object, static_cast<unsigned>(number->magnitude))
                    : nullptr;
    if (sub == nullptr) {
      if (!report.wants("unknown-sub-object")) continue;
      report.warning(entry.key_pos(), "unknown-sub-object",
                     "object " + hex(object.index) + " has no sub-object " + quoted(entry.key) +
                         " (decimal); the entry was left out");
      continue;
    }
    apply_entry(*sub, {object.index, sub->sub}, list, entry, values);
  }
}

void expand_compact_pdos(ObjectDictionary& dictionary) {
  if (dictionary.device.compact_pdo == 0) return;
  expand_direction(dictionary, false, dictionary.device.nr_rx_pdo);
  expand_direction(dictionary, true, dictionary.device.nr_tx_pdo);
}

}  // namespace takt
