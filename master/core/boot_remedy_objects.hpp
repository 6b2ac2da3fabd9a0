#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// What to try where a device refuses an object that takt writes by itself: the key of the network
/// file that governs it. Empty for other objects.
std::string against_refused_setting(const NodePlan& node, const BootFailure& failure);

/// What to try against abort codes that are rarely seen. Empty for others.
std::string against_rare_abort(const BootFailure& failure);

}  // namespace takt
