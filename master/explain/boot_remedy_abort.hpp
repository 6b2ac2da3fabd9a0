#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Says what the user can try when a device has answered a step of its boot with an SDO abort code.
std::string against_abort(const NodePlan& node, const BootStep& step, const BootFailure& failure);

}  // namespace takt
