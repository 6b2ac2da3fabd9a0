#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// The numbers that a device holds once it has booted: its power-on values, and over them what the
/// boot plan writes; or what it answered itself.
class DeviceValues {
 public:
  DeviceValues(const NodePlan& node, const DeviceTable& device);

  /// None: the device has no such object, or it is no number.
  std::optional<std::uint64_t> get(ObjectKey key) const;
  /// 16 bits, signed: the option codes of CiA 402.
  std::optional<int> option(std::uint16_t index) const;
  bool has(std::uint16_t index) const;
  /// The object can be written, and `value` is within its limits. By the EDS.
  bool takes(ObjectKey key, std::int64_t value) const;
  const std::map<ObjectKey, std::uint64_t>& all() const noexcept { return values_; }

  /// The device has answered. Where it holds another value than was expected, that is noted.
  void answered(ObjectKey key, std::span<const std::byte> bytes);
  /// The device says that it does not have the object.
  void missing(ObjectKey key);
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// What was found out while the device was asked.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::map<ObjectKey, std::uint64_t> values_;
  std::vector<DeviceObject> supervision_;  ///< writable objects of heartbeat and life guarding
  std::vector<std::string> notes_;
};

}  // namespace takt
