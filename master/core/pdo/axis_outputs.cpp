#include "master/core/pdo/axis_outputs.hpp"

#include <cstddef>

namespace takt {
namespace {

// CiA 402-1: the objects of the axes of a device are 0x800 apart, from 0x6000 to 0x9FFF.
constexpr std::uint16_t first_object = 0x6000;
constexpr std::uint16_t end_of_objects = 0xA000;
constexpr std::uint16_t axis_objects = 0x800;

constexpr std::uint16_t controlword = 0x6040;
constexpr std::uint16_t target_position = 0x607A;
constexpr std::uint16_t position_offset = 0x60B0;
constexpr std::uint16_t interpolation_data = 0x60C1;

bool is_position(ObjectKey first_axis) noexcept {
  if (first_axis.index == target_position) return first_axis.sub == 0;
  return first_axis.index == interpolation_data && first_axis.sub == 1;
}

}  // namespace

AxisOutputs axis_outputs(const ImageLayout& layout, SignalIndex target) {
  const Signal& signal = layout.signals[target];
  const std::uint16_t index = signal.object.index;
  if (index < first_object || index >= end_of_objects) return {};
  const auto shift =
      static_cast<std::uint16_t>((index - first_object) / axis_objects * axis_objects);
  if (!is_position({static_cast<std::uint16_t>(index - shift), signal.object.sub})) return {};
  AxisOutputs found;
  for (std::size_t i = layout.inputs; i < layout.signals.size(); ++i) {
    const Signal& other = layout.signals[i];
    if (other.node_index != signal.node_index || other.object.sub != 0) continue;
    if (other.object.index == controlword + shift) found.controlword = static_cast<SignalIndex>(i);
    if (other.object.index == position_offset + shift) found.offset = static_cast<SignalIndex>(i);
  }
  return found;
}

}  // namespace takt
