#pragma once
#include <span>
#include <takt/axis_control.hpp>
#include <takt/signal_t.hpp>
#include <vector>

namespace takt {

/// Finds the axes of a layout. An axis has both a controlword and a statusword. The result is
/// sorted by node-ID, then by the number of the axis in its device.
std::vector<AxisSignals> find_axes(std::span<const signal_t> signals);

}  // namespace takt
