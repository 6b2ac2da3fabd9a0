#include "master/explain/frame/frame_names.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "master/explain/emcy_text.hpp"

namespace takt {
namespace {

struct Range {
  std::uint16_t first;
  std::uint16_t last;
  std::string_view name;
  DataType type = DataType::unknown;  // type of sub-index 0 of a variable
};

constexpr std::array<Range, 64> communication_objects{{
    {0x1000, 0x1000, "device type", DataType::unsigned32},
    {0x1001, 0x1001, "error register", DataType::unsigned8},
    {0x1002, 0x1002, "manufacturer status register", DataType::unsigned32},
    {0x1003, 0x1003, "pre-defined error field"},
    {0x1005, 0x1005, "COB-ID SYNC", DataType::unsigned32},
    {0x1006, 0x1006, "communication cycle period", DataType::unsigned32},
    {0x1007, 0x1007, "synchronous window length", DataType::unsigned32},
    {0x1008, 0x1008, "manufacturer device name", DataType::visible_string},
    {0x1009, 0x1009, "manufacturer hardware version", DataType::visible_string},
    {0x100A, 0x100A, "manufacturer software version", DataType::visible_string},
    {0x100C, 0x100C, "guard time", DataType::unsigned16},
    {0x100D, 0x100D, "life time factor", DataType::unsigned8},
    {0x1010, 0x1010, "store parameters"},
    {0x1011, 0x1011, "restore default parameters"},
    {0x1012, 0x1012, "COB-ID TIME", DataType::unsigned32},
    {0x1013, 0x1013, "high resolution time stamp", DataType::unsigned32},
    {0x1014, 0x1014, "COB-ID EMCY", DataType::unsigned32},
    {0x1015, 0x1015, "inhibit time EMCY", DataType::unsigned16},
    {0x1016, 0x1016, "consumer heartbeat time"},
    {0x1017, 0x1017, "producer heartbeat time", DataType::unsigned16},
    {0x1018, 0x1018, "identity object"},
    {0x1019, 0x1019, "synchronous counter overflow", DataType::unsigned8},
    {0x1020, 0x1020, "verify configuration"},
    {0x1021, 0x1021, "store EDS", DataType::domain},
    {0x1022, 0x1022, "store format", DataType::unsigned16},
    {0x1028, 0x1028, "emergency consumer"},
    {0x1029, 0x1029, "error behavior"},
    {0x102A, 0x102A, "NMT inhibit time", DataType::unsigned16},
    {0x1200, 0x127F, "SDO server parameter"},
    {0x1280, 0x12FF, "SDO client parameter"},
    {0x1400, 0x15FF, "RPDO"},
    {0x1600, 0x17FF, "RPDO"},
    {0x1800, 0x19FF, "TPDO"},
    {0x1A00, 0x1BFF, "TPDO"},
    {0x1F20, 0x1F20, "store DCF"},
    {0x1F21, 0x1F21, "store format of DCFs"},
    {0x1F22, 0x1F22, "concise DCF"},
    {0x1F25, 0x1F25, "configure slave"},
    {0x1F26, 0x1F26, "expected configuration date"},
    {0x1F27, 0x1F27, "expected configuration time"},
    {0x1F50, 0x1F50, "program data"},
    {0x1F51, 0x1F51, "program control"},
    {0x1F52, 0x1F52, "verify application software"},
    {0x1F53, 0x1F53, "expected application software date"},
    {0x1F54, 0x1F54, "expected application software time"},
    {0x1F55, 0x1F55, "expected software identification"},
    {0x1F56, 0x1F56, "application software identification"},
    {0x1F57, 0x1F57, "flash status identification"},
    {0x1F80, 0x1F80, "NMT startup", DataType::unsigned32},
    {0x1F81, 0x1F81, "NMT slave assignment"},
    {0x1F82, 0x1F82, "request NMT"},
    {0x1F83, 0x1F83, "request node guarding"},
    {0x1F84, 0x1F84, "expected device type"},
    {0x1F85, 0x1F85, "expected vendor id"},
    {0x1F86, 0x1F86, "expected product code"},
    {0x1F87, 0x1F87, "expected revision number"},
    {0x1F88, 0x1F88, "expected serial number"},
    {0x1F89, 0x1F89, "boot time", DataType::unsigned32},
    {0x1F8A, 0x1F8A, "restore configuration"},
    {0x1F90, 0x1F90, "flying master timing"},
    {0x1F91, 0x1F91, "self-starting nodes timing"},
    {0x1F93, 0x1F93, "LSS configuration"},
    {0x1FA0, 0x1FCF, "object scanner list"},
    {0x1FD0, 0x1FFF, "object dispatching list"},
}};

const Range* range_of(std::uint16_t index) {
  const auto found = std::ranges::find_if(communication_objects, [index](const Range& range) {
    return index >= range.first && index <= range.last;
  });
  return found == communication_objects.end() ? nullptr : &*found;
}

}  // namespace

std::string communication_object_name(ObjectKey key) {
  const Range* range = range_of(key.index);
  if (range == nullptr) return {};
  constexpr std::array parameters{"highest sub-index", "COB-ID",   "transmission type",
                                  "inhibit time",      "reserved", "event timer",
                                  "SYNC start value"};
  constexpr std::array identity{"highest sub-index", "vendor id", "product code", "revision number",
                                "serial number"};
  const auto named = [&](const auto& names) -> std::string {
    return key.sub < names.size() ? names[key.sub] : "parameter";
  };
  if (key.index == 0x1018) return named(identity);
  if (key.index < 0x1400 || key.index >= 0x1C00) return std::string{range->name};
  const std::string pdo = fmt::format("{}{}", range->name, (key.index & 0x1FFU) + 1);
  const bool mapping = (key.index & 0x200U) != 0;
  if (!mapping) return fmt::format("{} {}", pdo, named(parameters));
  return key.sub == 0 ? pdo + " mapped objects" : fmt::format("{} mapping entry {}", pdo, key.sub);
}

std::string FrameNames::node(unsigned id) const {
  const NodePlan* const planned = plan_ == nullptr ? nullptr : plan_->find(id);
  if (planned != nullptr) return planned->name;
  if (plan_ != nullptr && id == plan_->master_id.value()) return "master";
  return fmt::format("node {}", id);
}

std::string FrameNames::object(unsigned node, ObjectKey key) const {
  std::string text = fmt::format("{:04X}:{:02X}", key.index, key.sub);
  std::string name = communication_object_name(key);
  if (plan_ != nullptr) {
    for (const Signal& signal : plan_->layout.signals) {
      if (signal.node.value() == node && signal.object == key) name = signal.name;
    }
  }
  if (!name.empty()) text.append(" ").append(name);
  return text;
}

DataType FrameNames::type(unsigned node, ObjectKey key) const {
  for (const DeviceTable& device : devices_) {
    if (device.node.value() != node) continue;
    const auto at = std::ranges::lower_bound(device.objects, key, {}, &DeviceObject::key);
    if (at != device.objects.end() && at->key == key) return at->type;
  }
  const Range* range = range_of(key.index);
  return range != nullptr && key.sub == 0 ? range->type : DataType::unknown;
}

std::string_view FrameNames::emcy(unsigned node, std::uint16_t code) const {
  return emcy_text(plan_ == nullptr ? nullptr : plan_->find(node), code);
}

std::optional<NodeId> FrameNames::emcy_sender(CobId id) const {
  if (plan_ != nullptr) {
    for (const NodePlan& node : plan_->nodes) {
      if (node.emcy_cob_id == id) return node.id;
    }
  }
  if (id.is_extended() || (id.id() & ~0x7FU) != 0x080) return {};
  return NodeId::from(id.id() & 0x7F);
}

}  // namespace takt
