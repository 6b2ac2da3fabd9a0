#pragma once
#include <vector>

#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// The CiA 402 axes of a device as the ordered stop needs them, from the values that the device has
/// once it has booted: its file, and what the boot plan writes over it. `spec`: its units and
/// limits.
std::vector<AxisPlan> compile_axes(const NodePlan& node, const DeviceTable& device,
                                   const NodeSpec& spec, NetworkReport& report);

/// The longest of `plan`; 0: none is known.
Time longest_stopping_time(const BusPlan& plan) noexcept;

/// Warns where the ordered stop gives a drive less time than its ramp needs, and where a drive can
/// not be confirmed because it coasts.
void judge_stop(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report);

}  // namespace takt
