#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// Values of the objects of a device after its boot: the power-on values of the EDS, overwritten by
/// the values that the boot plan writes. A value that the device itself has answered takes
/// precedence.
class DeviceValues {
 public:
  DeviceValues(const NodePlan& node, const DeviceTable& device);

  /// Returns the value of an object, or std::nullopt if the device has no such object. Only the
  /// first eight bytes of an object count.
  std::optional<std::uint64_t> get(ObjectKey key) const;
  /// Returns sub-index 0 of an object as a signed number of 16 bits, like the option codes of
  /// CiA 402. Returns std::nullopt if the device has no such object.
  std::optional<int> option(std::uint16_t index) const;
  /// Returns true if the device has at least one sub-index of this object.
  bool has(std::uint16_t index) const;
  /// Returns true if the EDS permits writing to the object and `value` is within its limits.
  bool takes(ObjectKey key, std::int64_t value) const;
  const std::map<ObjectKey, std::uint64_t>& all() const noexcept { return values_; }

  /// Takes a value that the device has answered. Adds a note if it is not the expected value.
  void answered(ObjectKey key, std::span<const std::byte> bytes);
  /// Removes an object because the device has answered that the object does not exist. Adds a note.
  void missing(ObjectKey key);
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// Returns the notes that answered(), missing() and note() have added.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  /// Limits of an object. An empty limit allows every value.
  struct Limits {
    std::optional<std::int64_t> low{};
    std::optional<std::int64_t> high{};
  };

  std::map<ObjectKey, std::uint64_t> values_;
  std::map<ObjectKey, Limits> writable_;
  std::vector<std::string> notes_;
};

}  // namespace takt
