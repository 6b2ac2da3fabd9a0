#pragma once
#include <span>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/speed_axis_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Finds the speed axes in the layout of `plan`: nodes whose device data or whose `speed_axis` name
/// a control word, a status word and a set speed that PDOs carry, and CiA 402 drives with 0x6042
/// and without another target. Sets the fallback of their control word and set speed for commands
/// that are too old: the drive stops along its ramp, unless the network file states another
/// fallback.
void compile_speed_axes(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report);

/// Returns true if the device data or the network file have a `speed_axis` section for this node,
/// and the network file does not switch the axis off.
bool has_speed_words(const NodeSource& node);

}  // namespace takt
