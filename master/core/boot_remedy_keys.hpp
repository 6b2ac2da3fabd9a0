#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// What to try where a device refuses an object that takt writes by itself: the key of the network
/// file that governs it. Empty for other objects.
std::string against_refused_setting(const NodePlan& node, const BootFailure& failure);

}  // namespace takt
