#include "eds_parser/plan/device/device_compiler.hpp"

#include <algorithm>
#include <cmath>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/profile_of.hpp"
#include "eds_parser/plan/device/device_mechanics.hpp"
#include "eds_parser/specification/device_data.hpp"
#include "eds_parser/values/pdo_number.hpp"

namespace takt {
namespace {

std::string model_of(const NodeSource& node) {
  if (!node.spec->sim.model.empty()) return node.spec->sim.model;
  const std::int64_t profile = profile_of(*node.dictionary);
  if (profile == 401) return "io401";
  if (profile == 402) return "drive402";
  return profile == 406 ? "encoder406" : "plain";
}

/// Widens the limits of an object so that they include `own`, a value of the device file itself.
void widen_limits(DeviceObject& object, const std::optional<Value>& own) {
  const auto value = integer_of(own);
  if (!value) return;
  if (object.low_limit) object.low_limit = std::min(*object.low_limit, *value);
  if (object.high_limit) object.high_limit = std::max(*object.high_limit, *value);
}

/// Returns the object with its value at power-on. A read-only object gets its value from the DCF. A
/// PDO without a known COB-ID is switched off.
DeviceObject object_of(std::uint16_t index, const SubObject& sub) {
  DeviceObject object{.key = {index, sub.sub},
                      .type = sub.type,
                      .access = sub.access,
                      .pdo_mappable = sub.pdo_mappable,
                      .low_limit = integer_of(sub.low_limit),
                      .high_limit = integer_of(sub.high_limit)};
  const bool use_default = sub.default_value && (sub.is_writable() || !sub.parameter_value);
  const auto& value = use_default ? sub.default_value : sub.parameter_value;
  if (value) {
    object.value = to_bytes(*value, sub.type);
  } else if (is_pdo_cob_id(object.key)) {
    object.value = to_bytes(Value{std::uint64_t{cob_id_off}}, DataType::unsigned32);
  } else {
    object.value.resize(byte_width(sub.type));
  }
  for (const auto& own : {sub.default_value, sub.parameter_value}) widen_limits(object, own);
  return object;
}

void set_value(DeviceTable& table, ObjectKey key, std::uint64_t value) {
  for (DeviceObject& object : table.objects) {
    if (object.key == key) object.value = to_bytes(Value{value}, object.type);
  }
}

}  // namespace

DeviceTable compile_device(const NodeSource& node) {
  const ObjectDictionary& dictionary = *node.dictionary;
  DeviceTable table{.node = node.id,
                    .name = node.spec->name,
                    .granularity = dictionary.device.granularity,
                    .model = model_of(node),
                    .quirks = node.spec->sim.quirks};
  for (unsigned n = 0; n < dictionary.dummy_usage.size(); ++n) {
    if (dictionary.dummy_usage[n]) table.dummy_usage |= static_cast<std::uint8_t>(1U << n);
  }
  for (const Object& object : dictionary.objects) {
    for (const SubObject& sub : object.subs) table.objects.push_back(object_of(object.index, sub));
  }
  // The simulated device gets the firmware and the serial number that the network file expects.
  if (node.firmware) {
    table.firmware = to_string(*node.firmware);
    const auto& parts = node.firmware->parts;
    if (node.data != nullptr && node.data->revision_is_firmware) {
      set_value(table, {0x1018, 3}, std::uint64_t{parts[0]} << 16 | parts[1]);
    }
  }
  if (node.spec->sim.mechanics && table.model == "drive402") {
    table.mechanics = compile_mechanics(node);
    const double rated = table.mechanics->motor.rated_torque * 1000;  // mN m
    set_value(table, {0x6076, 0}, static_cast<std::uint64_t>(std::llround(rated)));
  }
  if (*node.spec->serial_number != 0) set_value(table, {0x1018, 4}, *node.spec->serial_number);
  return table;
}

}  // namespace takt
