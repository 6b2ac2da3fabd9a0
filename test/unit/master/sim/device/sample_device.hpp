#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "eds_parser/table/device_table.hpp"

namespace takt::sim {

inline std::vector<std::byte> little_endian(std::uint64_t value, unsigned width) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < width; ++i) bytes.push_back(std::byte(value >> (8 * i) & 0xFF));
  return bytes;
}

/// Builds the table of a device by hand.
class SampleDevice {
 public:
  explicit SampleDevice(NodeId node) { table_.node = node; }

  SampleDevice& object(std::uint16_t index, std::uint8_t sub, DataType type, Access access,
                       std::uint64_t value, bool mappable = false) {
    table_.objects.push_back({.key = {index, sub},
                              .type = type,
                              .access = access,
                              .pdo_mappable = mappable,
                              .value = little_endian(value, byte_width(type)),
                              .low_limit = {},
                              .high_limit = {}});
    return *this;
  }
  SampleDevice& limits(std::int64_t low, std::int64_t high) {
    table_.objects.back().low_limit = low;
    table_.objects.back().high_limit = high;
    return *this;
  }
  SampleDevice& text(std::uint16_t index, std::uint8_t sub, std::string_view text,
                     Access access = Access::constant) {
    DeviceObject entry{.key = {index, sub},
                       .type = DataType::visible_string,
                       .access = access,
                       .value = {},
                       .low_limit = {},
                       .high_limit = {}};
    for (const char c : text) entry.value.push_back(std::byte(c));
    table_.objects.push_back(entry);
    return *this;
  }
  SampleDevice& pdo(std::uint16_t communication, std::uint32_t cob, std::uint8_t type,
                    std::vector<std::uint32_t> entries) {
    object(communication, 0, DataType::unsigned8, Access::constant, 6);
    object(communication, 1, DataType::unsigned32, Access::rw, cob);
    object(communication, 2, DataType::unsigned8, Access::rw, type);
    object(communication, 3, DataType::unsigned16, Access::rw, 0);
    object(communication, 5, DataType::unsigned16, Access::rw, 0);
    object(communication, 6, DataType::unsigned8, Access::rw, 0);
    const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
    object(mapping, 0, DataType::unsigned8, Access::rw, entries.size());
    entries.resize(8);
    for (std::uint8_t sub = 1; sub <= 8; ++sub) {
      object(mapping, sub, DataType::unsigned32, Access::rw, entries[sub - 1u]);
    }
    return *this;
  }
  SampleDevice& model(std::string name) {
    table_.model = std::move(name);
    return *this;
  }
  SampleDevice& quirk(std::string name) {
    table_.quirks.push_back(std::move(name));
    return *this;
  }
  DeviceTable build() {
    std::ranges::sort(table_.objects, {}, &DeviceObject::key);
    return table_;
  }

 private:
  DeviceTable table_{
      .node = NodeId::from(1).value(), .name = {}, .objects = {}, .model = {}, .quirks = {}};
};

/// Makes a device with all communication objects and two PDOs in each direction.
inline SampleDevice communicating(NodeId node) {
  const std::uint32_t id = node.value();
  SampleDevice device{node};
  using enum DataType;
  device.object(0x1000, 0, unsigned32, Access::ro, 0x0002'0192)
      .object(0x1001, 0, unsigned8, Access::ro, 0, true)
      .object(0x1003, 0, unsigned8, Access::rw, 0)
      .object(0x1003, 1, unsigned32, Access::ro, 0)
      .object(0x1003, 2, unsigned32, Access::ro, 0)
      .object(0x1005, 0, unsigned32, Access::rw, 0x80)
      .object(0x1006, 0, unsigned32, Access::rw, 0)
      .object(0x1007, 0, unsigned32, Access::rw, 0)
      .text(0x1008, 0, "Sample device v1")
      .object(0x1010, 0, unsigned8, Access::constant, 1)
      .object(0x1010, 1, unsigned32, Access::rw, 1)
      .object(0x1011, 0, unsigned8, Access::constant, 1)
      .object(0x1011, 1, unsigned32, Access::rw, 1)
      .object(0x1014, 0, unsigned32, Access::rw, 0x80 + id)
      .object(0x1015, 0, unsigned16, Access::rw, 0)
      .object(0x1016, 0, unsigned8, Access::constant, 2)
      .object(0x1016, 1, unsigned32, Access::rw, 0)
      .object(0x1016, 2, unsigned32, Access::rw, 0)
      .object(0x1017, 0, unsigned16, Access::rw, 0)
      .object(0x1018, 0, unsigned8, Access::constant, 4)
      .object(0x1018, 1, unsigned32, Access::ro, 0x15A)
      .object(0x1019, 0, unsigned8, Access::rw, 0)
      .object(0x1029, 0, unsigned8, Access::constant, 1)
      .object(0x1029, 1, unsigned8, Access::rw, 0);
  device.object(0x2000, 0, unsigned16, Access::rw, 0x1234)
      .object(0x2001, 0, unsigned8, Access::ro, 7)
      .object(0x2002, 0, unsigned32, Access::wo, 0)
      .object(0x2003, 0, integer16, Access::rw, 0)
      .limits(-100, 100)
      .text(0x2004, 0, "", Access::rw)
      .object(0x2010, 0, unsigned32, Access::rw, 0, true)
      .object(0x2011, 0, unsigned32, Access::rw, 0, true)
      .object(0x2012, 0, unsigned16, Access::rw, 0, true)
      .object(0x2013, 0, unsigned16, Access::ro, 0, true)
      .object(0x2014, 0, unsigned64, Access::rw, 0, true);
  return device;
}

}  // namespace takt::sim
