#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"
#include "master/sim/dictionary/abort.hpp"

namespace takt::sim {

/// One object or sub-object of a running device. `value` holds a number, cut to its width; `bytes`
/// holds a string or domain.
struct Object {
  ObjectKey key;
  DataType type = DataType::unknown;
  Access access = Access::rw;
  bool mappable = false;
  std::uint8_t width = 0;       ///< size of a number in bytes; 0 means a string or domain
  std::uint8_t sign_shift = 0;  ///< unused bits above a signed number in `value`; 0 if unsigned
  std::uint64_t value = 0;
  std::uint64_t mask = 0;      ///< the bits of `value` that the width covers
  std::uint64_t power_on = 0;  ///< value after reset: factory, or stored by 0x1010
  std::uint64_t factory = 0;
  std::optional<std::int64_t> low;
  std::optional<std::int64_t> high;
  std::vector<std::byte> bytes;
  std::vector<std::byte> power_on_bytes;
  std::vector<std::byte> factory_bytes;

  bool is_bytes() const noexcept { return width == 0; }
  /// Returns the number, sign-extended if its type is signed.
  std::int64_t number() const noexcept { return extended(value); }
  /// Returns a raw value, sign-extended if the type is signed.
  std::int64_t extended(std::uint64_t raw) const noexcept {
    return static_cast<std::int64_t>(raw << sign_shift) >> sign_shift;
  }
  void set(std::uint64_t raw) noexcept { value = raw & mask; }
  bool readable() const noexcept { return access != Access::wo; }
  bool writable() const noexcept { return access != Access::ro && access != Access::constant; }
};

/// The object dictionary of one device. The address of an object never changes.
class ObjectStore {
 public:
  /// Largest string or domain that may be written, in bytes.
  static constexpr std::size_t bytes_limit = 1 << 20;

  explicit ObjectStore(const DeviceTable& table);

  Object* find(ObjectKey key) noexcept;
  const Object* find(ObjectKey key) const noexcept {
    return const_cast<ObjectStore*>(this)->find(key);
  }
  /// Returns a numeric object. If there is none with this key, returns an object outside the
  /// dictionary that holds `constant`: its mask is empty, and its width is 0. Allocates.
  Object& number_or(ObjectKey key, std::int64_t constant);
  bool has_index(std::uint16_t index) const noexcept;
  /// Returns the number in an object, or `missing` if the object does not exist.
  std::int64_t number(ObjectKey key, std::int64_t missing = 0) const noexcept;
  /// Returns the objects with first <= index <= last.
  std::span<Object> range(std::uint16_t first, std::uint16_t last) noexcept;

  /// Checks that need only the object itself: access, size, limits.
  Abort may_read(ObjectKey key) const noexcept;
  Abort may_write(ObjectKey key, std::span<const std::byte> data) const noexcept;

  /// Sets the objects with indices first..last to their power-on values.
  void reset(std::uint16_t first, std::uint16_t last) noexcept;
  /// Makes the present values the power-on values.
  void save(std::uint16_t first, std::uint16_t last) noexcept;
  /// Makes the factory values the power-on values.
  void restore(std::uint16_t first, std::uint16_t last) noexcept;

 private:
  std::vector<Object> objects_;       ///< sorted by ascending key
  std::deque<Object> constants_;      ///< objects that number_or() has returned for missing objects
  std::vector<std::uint32_t> slots_;  ///< hash table of positions + 1; the size is a power of two
};

}  // namespace takt::sim
