#include "apps/takt/audit/ask_devices.hpp"

#include <algorithm>
#include <array>

namespace takt {
namespace {

constexpr std::uint32_t no_object = 0x0602'0000;
constexpr std::uint32_t timed_out = 0x0504'0000;  // abort code that the master itself sends
constexpr std::uint32_t no_sub_index = 0x0609'0011;

struct IndexRange {
  std::uint16_t first;
  std::uint16_t last;
};

/// Objects that an audit needs. The option codes of axis n are n * 0x800 higher.
constexpr std::array<IndexRange, 12> asked{{{0x1006, 0x1006},
                                            {0x100C, 0x100D},
                                            {0x1016, 0x1017},
                                            {0x1029, 0x1029},
                                            {0x6206, 0x6207},
                                            {0x6226, 0x6227},
                                            {0x6306, 0x6307},
                                            {0x6326, 0x6327},
                                            {0x6443, 0x6445},
                                            {0x6007, 0x6007},
                                            {0x605A, 0x605A},
                                            {0x605E, 0x605E}}};

bool matters(ObjectKey key) {
  const auto holds = [](unsigned index) {
    return std::ranges::any_of(asked, [=](const IndexRange& range) {
      return index >= range.first && index <= range.last;
    });
  };
  if (key.index >= 0x1400 && key.index <= 0x15FF) return key.sub == 5;
  const unsigned axis =
      key.index >= 0x6800 && key.index < 0xA000 ? (key.index - 0x6000) / 0x800 : 0;
  return holds(key.index) ||
         (axis != 0 && holds(key.index - 0x800 * axis) && key.index - 0x800 * axis < 0x6200);
}

}  // namespace

bool ask_device(NodeId node, DeviceValues& values, const ReadObject& read) {
  const auto there = read(node, {0x1000, 0});
  if (!there && (there.error().abort_code == 0 || there.error().abort_code == timed_out)) {
    values.note("the device does not answer (" + there.error().sentence +
                "): all values are those of EDS and network file");
    return false;
  }
  std::vector<ObjectKey> keys;
  for (const auto& [key, value] : values.all()) {
    if (matters(key)) keys.push_back(key);
  }
  for (const ObjectKey key : keys) {
    const auto value = read(node, key);
    if (value) {
      values.answered(key, *value);
    } else if (value.error().abort_code == no_object || value.error().abort_code == no_sub_index) {
      values.missing(key);
    } else {
      values.note(to_string(key) + " can't be read (" + value.error().sentence +
                  "): the value is that of EDS and network file");
    }
  }
  return true;
}

}  // namespace takt
