#include "apps/takt/audit/device_values.hpp"

#include <fmt/format.h>

#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

bool writes(BootAction action) {
  using enum BootAction;
  return action == write || action == write_if_differs || action == write_if_changed ||
         action == enable_pdo;
}

bool is_writable(const DeviceObject& object) {
  return object.access != Access::ro && object.access != Access::constant;
}

}  // namespace

DeviceValues::DeviceValues(const NodePlan& node, const DeviceTable& device) {
  for (const DeviceObject& object : device.objects) {
    values_[object.key] = from_little_endian(object.value);
    if (is_writable(object)) writable_[object.key] = {object.low_limit, object.high_limit};
  }
  if (!node.boot) return;
  for (const BootStep& step : node.boot_plan.steps) {
    const auto known = values_.find(step.object);
    if (writes(step.action) && known != values_.end())
      known->second = from_little_endian(step.value);
  }
}

std::optional<std::uint64_t> DeviceValues::get(ObjectKey key) const {
  const auto known = values_.find(key);
  if (known == values_.end()) return std::nullopt;
  return known->second;
}

std::optional<int> DeviceValues::option(std::uint16_t index) const {
  const auto value = get({index, 0});
  if (!value) return std::nullopt;
  return static_cast<std::int16_t>(*value & 0xFFFF);
}

void DeviceValues::answered(ObjectKey key, std::span<const std::byte> bytes) {
  const std::uint64_t value = from_little_endian(bytes);
  const auto known = values_.find(key);
  if (known != values_.end() && known->second != value) {
    note(fmt::format("{} is {} in the device, but {} by network file and EDS", to_string(key),
                     hex(static_cast<std::uint32_t>(value), 2),
                     hex(static_cast<std::uint32_t>(known->second), 2)));
  }
  values_[key] = value;
}

void DeviceValues::missing(ObjectKey key) {
  writable_.erase(key);
  if (values_.erase(key) != 0)
    note(to_string(key) + " is in the EDS, but the device does not have this object");
}

bool DeviceValues::takes(ObjectKey key, std::int64_t value) const {
  const auto known = writable_.find(key);
  if (known == writable_.end()) return false;
  const Limits& limits = known->second;
  return value >= limits.low.value_or(value) && value <= limits.high.value_or(value);
}

bool DeviceValues::has(std::uint16_t index) const {
  const auto next = values_.lower_bound({index, 0});
  return next != values_.end() && next->first.index == index;
}

}  // namespace takt
