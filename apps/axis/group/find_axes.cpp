#include "apps/axis/group/find_axes.hpp"

#include <array>
#include <map>
#include <utility>

namespace takt {
namespace {

/// The objects of axis n of a device are n * 0x800 higher than those of axis 0. CiA 402-2.
constexpr std::int32_t axis_step = 0x800;
constexpr std::int32_t first_profile_object = 0x6000;
constexpr std::int32_t last_profile_object = 0x9FFF;

constexpr std::int32_t point_of_interpolation = 0x60C1;

struct Meaning {
  std::int32_t object;
  bool output;
  AxisSignals::Position AxisSignals::* place;
  std::int16_t sub = 0;
};

constexpr std::array meanings{
    Meaning{0x6041, false, &AxisSignals::statusword},
    Meaning{0x6061, false, &AxisSignals::mode_display},
    Meaning{0x6064, false, &AxisSignals::position},
    Meaning{0x606C, false, &AxisSignals::velocity},
    Meaning{0x6077, false, &AxisSignals::torque},
    Meaning{0x6040, true, &AxisSignals::controlword},
    Meaning{0x6060, true, &AxisSignals::mode},
    Meaning{0x607A, true, &AxisSignals::target_position},
    Meaning{point_of_interpolation, true, &AxisSignals::target_position, 1},
    Meaning{0x60FF, true, &AxisSignals::target_velocity},
    Meaning{0x6071, true, &AxisSignals::target_torque},
    Meaning{0x60B1, true, &AxisSignals::velocity_offset},
    Meaning{0x60B2, true, &AxisSignals::torque_offset},
};

/// Returns the meaning of the object within its axis, or null if the axis library does not use the
/// object.
const Meaning* meaning_of(const signal_t& signal) {
  if (signal.index < first_profile_object || signal.index > last_profile_object) return nullptr;
  const std::int32_t object = first_profile_object + signal.index % axis_step;
  for (const Meaning& meaning : meanings) {
    const bool same = meaning.object == object && meaning.output == (signal.output != 0);
    if (same && signal.sub == meaning.sub) return &meaning;
  }
  return nullptr;
}

}  // namespace

std::int8_t number_of_axis(std::int32_t object) noexcept {
  return static_cast<std::int8_t>((object - first_profile_object) / axis_step + 1);
}

std::vector<AxisSignals> find_axes(std::span<const signal_t> signals) {
  std::map<std::pair<std::int16_t, std::int8_t>, AxisSignals> found;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const signal_t& signal = signals[i];
    const Meaning* meaning = meaning_of(signal);
    if (meaning == nullptr) continue;
    const std::int8_t number = number_of_axis(signal.index);
    AxisSignals& axis = found[{signal.node_id, number}];
    axis.name = number == 1 ? signal.node : signal.node + "." + std::to_string(number);
    axis.node = signal.node_id;
    if (meaning->object == point_of_interpolation) {
      if (axis.target_position) continue;  // 0x607A, whose signals come first in a layout
      axis.interpolates = true;
    }
    axis.*(meaning->place) = i;
  }
  std::vector<AxisSignals> axes;
  for (auto& [key, axis] : found) {
    if (axis.controlword && axis.statusword) axes.push_back(std::move(axis));
  }
  return axes;
}

}  // namespace takt
