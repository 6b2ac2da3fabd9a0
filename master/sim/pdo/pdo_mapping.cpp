#include "master/sim/pdo/pdo_mapping.hpp"

namespace takt::sim {
namespace {

constexpr std::uint32_t last_dummy = 7;

constexpr ObjectKey key_of(std::uint64_t entry) noexcept {
  return {static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)};
}

Abort check_dummy(const MappingRules& rules, ObjectKey key, unsigned bits) noexcept {
  if (rules.direction == PdoDirection::transmit || key.sub != 0) return Abort::no_object;
  if ((rules.dummy_usage >> key.index & 1) == 0) return Abort::no_object;
  return bits == bit_width(static_cast<DataType>(key.index)) ? Abort::none : Abort::type_mismatch;
}

bool direction_fits(const Object& object, PdoDirection direction) noexcept {
  return direction == PdoDirection::transmit ? object.readable() : object.writable();
}

}  // namespace

Abort check_entry(const ObjectStore& store, const MappingRules& rules,
                  std::uint64_t entry) noexcept {
  const ObjectKey key = key_of(entry);
  const auto bits = static_cast<unsigned>(entry & 0xFF);
  if (key.index != 0 && key.index <= last_dummy) return check_dummy(rules, key, bits);
  const Object* object = store.find(key);
  if (object == nullptr) return store.has_index(key.index) ? Abort::no_sub : Abort::no_object;
  if (!object->mappable || object->is_bytes()) return Abort::not_mappable;
  if (!direction_fits(*object, rules.direction)) return Abort::not_mappable;
  const unsigned width = bit_width(object->type);
  if (bits > width) return Abort::not_mappable;
  return bits < width ? Abort::type_mismatch : Abort::none;
}

bool PdoMapping::add(ObjectStore& store, std::uint64_t entry) noexcept {
  const auto bits = static_cast<std::uint8_t>(entry & 0xFF);
  if (bits == 0 || bits_ + bits > 64) return false;
  const ObjectKey key = key_of(entry);
  Object* const object = key.index <= last_dummy ? nullptr : store.find(key);
  if (object != nullptr) {
    places_[count_++] = {.object = object,
                         .mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1,
                         .shift = bits_};
  }
  bits_ = static_cast<std::uint8_t>(bits_ + bits);
  return true;
}

std::uint64_t PdoMapping::pack() const noexcept {
  std::uint64_t data = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Place& place = places_[i];
    data |= (place.object->value & place.mask) << place.shift;
  }
  return data;
}

void PdoMapping::unpack(std::uint64_t data) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const Place& place = places_[i];
    place.object->value = (data >> place.shift) & place.mask;
  }
}

}  // namespace takt::sim
