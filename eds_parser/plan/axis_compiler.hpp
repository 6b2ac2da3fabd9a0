#pragma once
#include <vector>

#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// Returns the CiA 402 axes of a device in the form that the ordered stop needs. The values are
/// those that the device has after its boot: the values of its device file, overwritten by the boot
/// plan. `source` supplies the units and limits of the node.
std::vector<AxisPlan> compile_axes(const NodePlan& node, const DeviceTable& device,
                                   const NodeSource& source, NetworkReport& report);

/// Returns the longest stopping time of all axes of `plan`. 0 means that no stopping time is known.
Time longest_stopping_time(const BusPlan& plan) noexcept;

/// Warns if the ordered stop gives a drive less time than its ramp needs, and if the standstill of
/// a drive can not be confirmed because the drive coasts.
void judge_stop(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report);

}  // namespace takt
