#include "eds_parser/plan/device/device_compiler.hpp"

#include <algorithm>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/profile_of.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

std::string model_of(const NodeSource& node) {
  if (!node.spec->sim.model.empty()) return node.spec->sim.model;
  switch (profile_of(*node.dictionary)) {
    case 401:
      return "io401";
    case 402:
      return "drive402";
    case 406:
      return "encoder406";
    default:
      return "plain";
  }
}

constexpr std::uint64_t pdo_off = 0x8000'0000;

bool is_pdo_cob_id(ObjectKey key) {
  const bool communication =
      (key.index >= 0x1400 && key.index <= 0x15FF) || (key.index >= 0x1800 && key.index <= 0x19FF);
  return communication && key.sub == 1;
}

/// Widens the limits of an object so that the device accepts the values of its own file.
void widen_limits(DeviceObject& object, const std::optional<Value>& own) {
  const auto value = integer_of(own);
  if (!value) return;
  if (object.low_limit) object.low_limit = std::min(*object.low_limit, *value);
  if (object.high_limit) object.high_limit = std::max(*object.high_limit, *value);
}

/// Read-only objects get their value from the DCF. A PDO of unknown COB-ID is off.
DeviceObject object_of(std::uint16_t index, const SubObject& sub) {
  DeviceObject object{.key = {index, sub.sub},
                      .type = sub.type,
                      .access = sub.access,
                      .pdo_mappable = sub.pdo_mappable,
                      .value = {},
                      .low_limit = {},
                      .high_limit = {}};
  const bool fixed = sub.access == Access::ro || sub.access == Access::constant;
  const bool use_default = sub.default_value && !(fixed && sub.parameter_value);
  const auto& value = use_default ? sub.default_value : sub.parameter_value;
  if (value) {
    object.value = to_bytes(*value, sub.type);
  } else if (is_pdo_cob_id(object.key)) {
    object.value = to_bytes(Value{pdo_off}, DataType::unsigned32);
  } else {
    object.value.resize(byte_width(sub.type));
  }
  object.low_limit = integer_of(sub.low_limit);
  object.high_limit = integer_of(sub.high_limit);
  for (const auto& own : {sub.default_value, sub.parameter_value}) widen_limits(object, own);
  return object;
}

/// Makes the simulated device report its configured firmware.
void set_firmware(const NodeSource& node, DeviceTable& table) {
  table.firmware = to_string(*node.firmware);
  if (node.data == nullptr || !node.data->revision_is_firmware) return;
  const std::uint64_t revision =
      std::uint64_t{node.firmware->parts[0]} << 16 | node.firmware->parts[1];
  for (DeviceObject& object : table.objects) {
    if (object.key == ObjectKey{0x1018, 3}) object.value = to_bytes(Value{revision}, object.type);
  }
}

/// Gives the simulated device the serial number that the network file expects.
void set_serial_number(const NodeSpec& node, DeviceTable& table) {
  if (!node.serial_number.given || *node.serial_number == 0) return;
  const std::uint64_t serial = *node.serial_number;
  for (DeviceObject& object : table.objects) {
    if (object.key == ObjectKey{0x1018, 4}) object.value = to_bytes(Value{serial}, object.type);
  }
}

}  // namespace

DeviceTable compile_device(const NodeSource& node) {
  const ObjectDictionary& dictionary = *node.dictionary;
  DeviceTable table{.node = node.id,
                    .name = node.spec->name,
                    .objects = {},
                    .granularity = dictionary.device.granularity,
                    .dummy_usage = 0,
                    .model = model_of(node),
                    .quirks = node.spec->sim.quirks};
  for (unsigned n = 0; n < dictionary.dummy_usage.size(); ++n) {
    if (dictionary.dummy_usage[n]) table.dummy_usage |= static_cast<std::uint8_t>(1U << n);
  }
  for (const Object& object : dictionary.objects) {
    for (const SubObject& sub : object.subs) table.objects.push_back(object_of(object.index, sub));
  }
  if (node.firmware) set_firmware(node, table);
  set_serial_number(*node.spec, table);
  return table;
}

}  // namespace takt
