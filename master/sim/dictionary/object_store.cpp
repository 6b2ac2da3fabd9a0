#include "master/sim/dictionary/object_store.hpp"

#include <algorithm>
#include <bit>

#include "eds_parser/values/little_endian.hpp"

namespace takt::sim {
namespace {

std::size_t hash(ObjectKey key) noexcept {
  const std::uint32_t packed = std::uint32_t{key.index} << 8 | key.sub;
  return (packed * 0x9E37'79B1u) >> 8;
}

Object make_object(const DeviceObject& entry) {
  Object object;
  object.key = entry.key;
  object.type = entry.type;
  object.access = entry.access;
  object.mappable = entry.pdo_mappable;
  object.width = static_cast<std::uint8_t>(byte_width(entry.type));
  const unsigned bits = 8u * std::min<unsigned>(object.width, 8);
  object.mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  if (is_signed(entry.type)) object.sign_shift = static_cast<std::uint8_t>(64 - bits);
  object.low = entry.low_limit;
  object.high = entry.high_limit;
  if (object.is_bytes()) {
    object.bytes = object.power_on_bytes = object.factory_bytes = entry.value;
  } else {
    object.set(from_little_endian(entry.value));
    object.power_on = object.factory = object.value;
  }
  return object;
}

bool below(std::uint64_t value, std::int64_t limit, bool with_sign) noexcept {
  if (with_sign) return static_cast<std::int64_t>(value) < limit;
  return limit > 0 && value < static_cast<std::uint64_t>(limit);
}

bool above(std::uint64_t value, std::int64_t limit, bool with_sign) noexcept {
  if (with_sign) return static_cast<std::int64_t>(value) > limit;
  return limit >= 0 && value > static_cast<std::uint64_t>(limit);
}

Abort check_limits(const Object& object, std::uint64_t raw) noexcept {
  if (is_real(object.type)) return Abort::none;
  const bool with_sign = is_signed(object.type);
  const auto value = static_cast<std::uint64_t>(object.extended(raw & object.mask));
  if (object.high && above(value, *object.high, with_sign)) return Abort::value_high;
  if (object.low && below(value, *object.low, with_sign)) return Abort::value_low;
  return Abort::none;
}

}  // namespace

ObjectStore::ObjectStore(const DeviceTable& table) {
  objects_.reserve(table.objects.size());
  for (const DeviceObject& entry : table.objects) objects_.push_back(make_object(entry));
  std::ranges::sort(objects_, {}, &Object::key);
  slots_.assign(std::bit_ceil(objects_.size() * 2 + 2), 0);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    std::size_t slot = hash(objects_[i].key) & (slots_.size() - 1);
    while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

Object* ObjectStore::find(ObjectKey key) noexcept {
  for (std::size_t slot = hash(key);; ++slot) {
    const std::uint32_t position = slots_[slot & (slots_.size() - 1)];
    if (position == 0) return nullptr;
    if (objects_[position - 1].key == key) return &objects_[position - 1];
  }
}

Object& ObjectStore::number_or(ObjectKey key, std::int64_t constant) {
  Object* const object = find(key);
  if (object != nullptr && !object->is_bytes()) return *object;
  Object& other = constants_.emplace_back();
  other.value = static_cast<std::uint64_t>(constant);
  return other;
}

bool ObjectStore::has_index(std::uint16_t index) const noexcept {
  const auto at = std::ranges::lower_bound(objects_, ObjectKey{index, 0}, {}, &Object::key);
  return at != objects_.end() && at->key.index == index;
}

std::int64_t ObjectStore::number(ObjectKey key, std::int64_t missing) const noexcept {
  const Object* object = find(key);
  return object == nullptr ? missing : object->number();
}

std::span<Object> ObjectStore::range(std::uint16_t first, std::uint16_t last) noexcept {
  const auto from = std::ranges::lower_bound(objects_, ObjectKey{first, 0}, {}, &Object::key);
  const auto to = std::ranges::upper_bound(objects_, ObjectKey{last, 255}, {}, &Object::key);
  return from < to ? std::span<Object>{from, to} : std::span<Object>{};
}

Abort ObjectStore::may_read(ObjectKey key) const noexcept {
  const Object* object = find(key);
  if (object == nullptr) return has_index(key.index) ? Abort::no_sub : Abort::no_object;
  return object->readable() ? Abort::none : Abort::write_only;
}

Abort ObjectStore::may_write(ObjectKey key, std::span<const std::byte> data) const noexcept {
  const Object* object = find(key);
  if (object == nullptr) return has_index(key.index) ? Abort::no_sub : Abort::no_object;
  if (!object->writable()) return Abort::read_only;
  if (object->is_bytes()) return data.size() > bytes_limit ? Abort::too_long : Abort::none;
  if (data.size() > object->width) return Abort::too_long;
  if (data.size() < object->width) return Abort::too_short;
  return check_limits(*object, from_little_endian(data));
}

void ObjectStore::reset(std::uint16_t first, std::uint16_t last) noexcept {
  for (Object& object : range(first, last)) {
    object.value = object.power_on;
    if (object.is_bytes()) object.bytes = object.power_on_bytes;
  }
}

void ObjectStore::save(std::uint16_t first, std::uint16_t last) noexcept {
  for (Object& object : range(first, last)) {
    if (!object.writable()) continue;
    object.power_on = object.value;
    if (object.is_bytes()) object.power_on_bytes = object.bytes;
  }
}

void ObjectStore::restore(std::uint16_t first, std::uint16_t last) noexcept {
  for (Object& object : range(first, last)) {
    object.power_on = object.factory;
    if (object.is_bytes()) object.power_on_bytes = object.factory_bytes;
  }
}

}  // namespace takt::sim
