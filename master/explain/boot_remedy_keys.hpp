#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Says what the user can try when a device refuses an object that takt writes by itself: the text
/// names the key of the network file that governs the object. Returns an empty text for other
/// objects.
std::string against_refused_setting(const NodePlan& node, const BootFailure& failure);

}  // namespace takt
