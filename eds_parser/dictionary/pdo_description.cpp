#include "eds_parser/dictionary/pdo_description.hpp"

#include <algorithm>
#include <limits>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/ini/number.hpp"

namespace takt {
namespace {

constexpr std::uint16_t pdos_per_direction = 512;
constexpr std::uint8_t most_entries = 64;  // CiA 301, 7.5.2.36; higher numbers mark MPDOs

std::optional<std::uint64_t> unsigned_value(const ObjectDictionary& dictionary, ObjectKey key) {
  const auto integer = integer_of(dictionary, key);
  if (!integer) return std::nullopt;
  return static_cast<std::uint64_t>(*integer);
}

template <class T>
std::optional<T> narrow(std::optional<std::uint64_t> value) noexcept {
  if (!value || *value > std::numeric_limits<T>::max()) return std::nullopt;
  return static_cast<T>(*value);
}

/// Returns the COB-ID without an unknown node-ID. The constant term contains its flags.
std::optional<std::uint64_t> constant_term(const SubObject& sub) noexcept {
  const auto number =
      parse_number(sub.parameter_text.empty() ? sub.default_text : sub.parameter_text);
  if (!number || number->negative) return std::nullopt;
  return number->magnitude;
}

void read_cob_id(PdoDescription& pdo, const ObjectDictionary& dictionary) {
  const ObjectKey key{pdo.communication_index(), 1};
  const auto* sub = dictionary.find(key);
  if (sub == nullptr) return;
  pdo.cob_id_raw = narrow<std::uint32_t>(unsigned_value(dictionary, key));
  const auto flags = pdo.cob_id_raw ? *pdo.cob_id_raw : constant_term(*sub);
  if (!flags) return;
  if (!pdo.cob_id_raw) pdo.cob_id_offset = static_cast<std::uint32_t>(*flags & 0x1FFF'FFFF);
  pdo.valid = (*flags & 0x8000'0000) == 0;
  pdo.rtr_allowed = (*flags & 0x4000'0000) == 0;
  pdo.extended = (*flags & 0x2000'0000) != 0;
}

MappedObject entry_of(std::uint32_t raw, const ObjectDictionary& dictionary) {
  MappedObject entry;
  entry.key = {static_cast<std::uint16_t>(raw >> 16), static_cast<std::uint8_t>(raw >> 8)};
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
  pdo.mapping_count = narrow<std::uint8_t>(unsigned_value(dictionary, {record->index, 0}));
  const auto count = pdo.mapping_count.value_or(most_entries);
  if (count > most_entries) return;
  for (const auto& sub : record->subs) {
    if (sub.sub == 0 || sub.sub > count) continue;
    const auto raw = narrow<std::uint32_t>(unsigned_value(dictionary, {record->index, sub.sub}));
    if (raw.value_or(0) == 0) continue;
    auto entry = entry_of(*raw, dictionary);
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
  pdo.transmission_type = narrow<std::uint8_t>(unsigned_value(dictionary, {index, 2}));
  const auto inhibit = narrow<std::uint16_t>(unsigned_value(dictionary, {index, 3}));
  pdo.inhibit_time_us = std::uint32_t{inhibit.value_or(0)} * 100;
  pdo.event_timer_ms = narrow<std::uint16_t>(unsigned_value(dictionary, {index, 5})).value_or(0);
  if (is_tpdo) pdo.sync_start = narrow<std::uint8_t>(unsigned_value(dictionary, {index, 6}));
  read_mapping(pdo, dictionary);
  return pdo;
}

}  // namespace

const Object* mappable_record(const ObjectDictionary& dictionary) noexcept {
  const auto it = std::ranges::find_if(dictionary.objects, [](const Object& object) {
    const bool is_mapping = (object.index & 0xFE00) == 0x1600 || (object.index & 0xFE00) == 0x1A00;
    if (!is_mapping || object.subs.empty()) return false;
    const SubObject& count = object.subs.front();
    return count.sub == 0 && count.access != Access::ro && count.access != Access::constant;
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
