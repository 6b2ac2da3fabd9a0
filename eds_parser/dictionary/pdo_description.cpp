#include "eds_parser/dictionary/pdo_description.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/ini/number.hpp"

namespace takt {
namespace {

constexpr std::uint16_t pdos_per_direction = 512;
constexpr std::uint8_t most_entries = 64;  // CiA 301, 7.5.2.36; higher numbers mark MPDOs

/// Returns the value of an object, or std::nullopt if there is no value or a `T` can't hold it.
template <class T>
std::optional<T> value_of(const ObjectDictionary& dictionary, ObjectKey key) noexcept {
  const auto value = unsigned_of(dictionary, key);
  if (!value || *value > std::numeric_limits<T>::max()) return std::nullopt;
  return static_cast<T>(*value);
}

/// Returns the constant part of a COB-ID with its flags, without the node-ID that a formula adds.
std::optional<std::uint64_t> constant_term(const SubObject& sub) noexcept {
  const auto number = parse_number(sub.text());
  if (!number || number->negative) return std::nullopt;
  return number->magnitude;
}

void read_cob_id(PdoDescription& pdo, const ObjectDictionary& dictionary) {
  const ObjectKey key{pdo.communication_index(), 1};
  const auto* sub = dictionary.find(key);
  if (sub == nullptr) return;
  pdo.cob_id_raw = value_of<std::uint32_t>(dictionary, key);
  const auto flags = pdo.cob_id_raw ? *pdo.cob_id_raw : constant_term(*sub);
  if (!flags) return;
  if (!pdo.cob_id_raw) pdo.cob_id_offset = static_cast<std::uint32_t>(*flags & 0x1FFF'FFFF);
  pdo.valid = (*flags & 0x8000'0000) == 0;
  pdo.rtr_allowed = (*flags & 0x4000'0000) == 0;
  pdo.extended = (*flags & 0x2000'0000) != 0;
}

MappedObject entry_of(std::uint32_t raw, std::uint8_t sub_index,
                      const ObjectDictionary& dictionary) {
  MappedObject entry;
  entry.key = {static_cast<std::uint16_t>(raw >> 16), static_cast<std::uint8_t>(raw >> 8)};
  entry.sub = sub_index;
  entry.bits = static_cast<std::uint8_t>(raw);
  if (entry.is_dummy()) {
    entry.name = "dummy";
  } else if (const auto* sub = dictionary.find(entry.key)) {
    entry.name = sub->name;
  }
  return entry;
}

void read_mapping(PdoDescription& pdo, const ObjectDictionary& dictionary) {
  const auto* record = dictionary.find(pdo.mapping_index());
  if (record == nullptr) return;
  pdo.mapping_count = value_of<std::uint8_t>(dictionary, {record->index, 0});
  const auto count = pdo.mapping_count.value_or(most_entries);
  if (count > most_entries) return;
  for (const auto& sub : record->subs) {
    if (sub.sub == 0 || sub.sub > count) continue;
    const auto raw = value_of<std::uint32_t>(dictionary, {record->index, sub.sub}).value_or(0);
    if (raw == 0) continue;
    auto entry = entry_of(raw, sub.sub, dictionary);
    entry.bit_offset = static_cast<std::uint16_t>(pdo.bits);
    pdo.bits += entry.bits;
    pdo.mapping.push_back(std::move(entry));
  }
}

PdoDescription describe(const ObjectDictionary& dictionary, bool is_tpdo, std::uint16_t number) {
  PdoDescription pdo;
  pdo.number = number;
  pdo.is_tpdo = is_tpdo;
  const auto index = pdo.communication_index();
  read_cob_id(pdo, dictionary);
  pdo.transmission_type = value_of<std::uint8_t>(dictionary, {index, 2});
  pdo.inhibit_time_us = value_of<std::uint16_t>(dictionary, {index, 3}).value_or(0) * 100U;
  pdo.event_timer_ms = value_of<std::uint16_t>(dictionary, {index, 5}).value_or(0);
  if (is_tpdo) pdo.sync_start = value_of<std::uint8_t>(dictionary, {index, 6});
  read_mapping(pdo, dictionary);
  return pdo;
}

}  // namespace

const Object* mappable_record(const ObjectDictionary& dictionary) noexcept {
  const auto it = std::ranges::find_if(dictionary.objects, [](const Object& object) {
    if (!is_pdo_mapping(object.index) || object.subs.empty()) return false;
    const SubObject& count = object.subs.front();
    return count.sub == 0 && count.is_writable();
  });
  return it == dictionary.objects.end() ? nullptr : &*it;
}

std::vector<PdoDescription> describe_pdos(const ObjectDictionary& dictionary) {
  std::vector<PdoDescription> pdos;
  for (const bool is_tpdo : {false, true}) {
    const std::uint16_t first = is_tpdo ? 0x1800 : 0x1400;
    auto it = std::ranges::lower_bound(dictionary.objects, first, {}, &Object::index);
    for (; it != dictionary.objects.end() && it->index < first + pdos_per_direction; ++it) {
      pdos.push_back(
          describe(dictionary, is_tpdo, static_cast<std::uint16_t>(it->index - first + 1)));
    }
  }
  return pdos;
}

}  // namespace takt
