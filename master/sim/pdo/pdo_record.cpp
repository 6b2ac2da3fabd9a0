#include "master/sim/pdo/pdo_record.hpp"

#include "eds_parser/values/pdo_number.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t communication_index(PdoDirection direction, std::uint16_t number) noexcept {
  return PdoNumber{number, direction == PdoDirection::transmit}.communication_index();
}

}  // namespace

bool PdoRecord::exists(const ObjectStore& store, PdoDirection direction, std::uint16_t number) {
  const Object* cob = store.find({communication_index(direction, number), 1});
  return cob != nullptr && cob->width == 4;
}

PdoRecord::PdoRecord(ObjectStore& store, PdoDirection direction, std::uint16_t number)
    : store_{store},
      number_{number},
      communication_{communication_index(direction, number)},
      cob_{store.find({communication_, 1})},
      type_{store.find({communication_, 2})},
      inhibit_{direction == PdoDirection::transmit ? store.find({communication_, 3}) : nullptr},
      timer_{store.find({communication_, 5})},
      start_{direction == PdoDirection::transmit ? store.find({communication_, 6}) : nullptr},
      count_{store.find({static_cast<std::uint16_t>(communication_ + 0x200), 0})} {}

Time PdoRecord::inhibit() const noexcept {
  if (inhibit_ == nullptr) return Time{};
  return std::chrono::microseconds{100} * static_cast<std::int64_t>(inhibit_->value);
}

Abort PdoRecord::check_write(const MappingRules& rules, const Object& object,
                             std::uint64_t raw) const noexcept {
  if (object.key.index == communication_) {
    if (&object == cob_) return check_cob(raw);
    if (&object == type_) return check_type(rules.direction, raw);
    if (&object == inhibit_ && valid() && raw != object.value) return Abort::value;
    if (&object == start_ && (raw > 240 || (valid() && raw != object.value))) return Abort::value;
    return Abort::none;
  }
  // If the COB-ID can't be written, a client can't disable the PDO before it changes the mapping.
  if (valid() && cob_->writable()) return Abort::unsupported_access;
  if (&object == count_) return check_count(rules, raw);
  if (count_ != nullptr && count_->value != 0) return Abort::unsupported_access;
  return raw == 0 || raw == object.factory ? Abort::none : check_entry(store_, rules, raw);
}

Abort PdoRecord::check_cob(std::uint64_t raw) const noexcept {
  const bool will_be_valid = (raw & cob_invalid) == 0;
  if (valid() && will_be_valid && raw != cob_->value) return Abort::value;
  if (has_stray_bits(raw)) return Abort::value;
  if (!will_be_valid) return Abort::none;
  if (is_restricted(cob_id(raw))) return Abort::value;
  const bool on_request_only = type() == 252 || type() == 253;
  if (on_request_only && (raw & cob_bit30) != 0) return Abort::value;
  return count_ == nullptr || count_->value == 0 ? Abort::value : Abort::none;
}

Abort PdoRecord::check_type(PdoDirection direction, std::uint64_t raw) const noexcept {
  const std::uint64_t last_reserved = direction == PdoDirection::receive ? 253 : 251;
  return raw >= 241 && raw <= last_reserved ? Abort::value : Abort::none;
}

/// Checks the whole mapping when a write to sub-index 0 enables it.
Abort PdoRecord::check_count(const MappingRules& rules, std::uint64_t raw) const noexcept {
  if (raw == source_mark || raw == destination_mark) return Abort::none;
  if (raw > 64) return Abort::value;
  std::uint64_t bits = 0;
  for (std::uint64_t sub = 1; sub <= raw; ++sub) {
    const Object* entry = store_.find(
        {static_cast<std::uint16_t>(communication_ + 0x200), static_cast<std::uint8_t>(sub)});
    if (entry == nullptr) return Abort::pdo_length;
    const bool own = entry->value != 0 &&
                     entry->value == entry->factory;  // a device always accepts its factory mapping
    const Abort refused = own ? Abort::none : check_entry(store_, rules, entry->value);
    if (refused != Abort::none) return refused;
    bits += entry->value & 0xFF;
  }
  return bits > 64 ? Abort::pdo_length : Abort::none;
}

void PdoRecord::compile(PdoMapping& mapping) const noexcept {
  mapping.clear();
  if (multiplex() != Multiplex::none) return;
  const std::uint64_t count = count_ == nullptr ? 0 : count_->value;
  for (std::uint64_t sub = 1; sub <= count && sub <= 64; ++sub) {
    const Object* entry = store_.find(
        {static_cast<std::uint16_t>(communication_ + 0x200), static_cast<std::uint8_t>(sub)});
    if (entry == nullptr || !mapping.add(store_, entry->value)) return;
  }
}

}  // namespace takt::sim
