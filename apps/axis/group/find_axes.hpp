#pragma once
#include <cstdint>
#include <span>
#include <takt/axis_control.hpp>
#include <takt/signal_t.hpp>
#include <vector>

namespace takt {

/// Finds the axes of a layout. An axis has both a controlword and a statusword. The result is
/// sorted by node-ID, then by the number of the axis in its device.
std::vector<AxisSignals> find_axes(std::span<const signal_t> signals);

/// Returns the number of the axis in its device, 1 to 8, to which an object of the profile belongs.
std::int8_t number_of_axis(std::int32_t object) noexcept;

}  // namespace takt
