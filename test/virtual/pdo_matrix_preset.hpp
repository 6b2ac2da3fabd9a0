#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/table/device_table.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::test {

/// Sets the power-on value of an object.
inline void preset(DeviceTable& table, ObjectKey key, std::uint64_t value) {
  const auto object = std::ranges::find(table.objects, key, &DeviceObject::key);
  object->value = sim::little_endian(value, static_cast<unsigned>(object->value.size()));
}

}  // namespace takt::test
