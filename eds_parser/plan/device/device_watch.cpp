#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

bool writes(const BootStep& step, ObjectKey key) noexcept {
  const bool any = step.action == BootAction::write ||
                   step.action == BootAction::write_if_differs ||
                   step.action == BootAction::write_if_changed;
  return any && step.object == key;
}

/// Returns the last value that the boot writes, else the value of the device file.
std::int64_t value_after_boot(const ObjectDictionary& dictionary, const BootPlan& boot,
                              ObjectKey key) {
  std::int64_t value = integer_of(dictionary, key).value_or(0);
  for (const BootStep& step : boot.steps) {
    if (writes(step, key)) value = static_cast<std::int64_t>(from_little_endian(step.value));
  }
  return value;
}

}  // namespace

void set_device_watch(const ObjectDictionary& dictionary, NodePlan& node) {
  const auto value = [&](ObjectKey key) {
    return value_after_boot(dictionary, node.boot_plan, key);
  };
  if (const Object* consumers = dictionary.find(std::uint16_t{0x1016})) {
    for (const SubObject& entry : consumers->subs) {
      const std::int64_t raw = entry.sub == 0 ? 0 : value({0x1016, entry.sub});
      const auto producer = NodeId::from(static_cast<unsigned>(raw >> 16 & 0xFF));
      if (!producer || (raw & 0xFFFF) == 0) continue;
      node.watches.push_back(
          {.producer = *producer, .longest = std::chrono::milliseconds{raw & 0xFFFF}});
    }
  }
  node.life_guarding =
      std::chrono::milliseconds{value({0x100C, 0}) & 0xFFFF} * (value({0x100D, 0}) & 0xFF);
}

}  // namespace takt
