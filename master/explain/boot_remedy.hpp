#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Returns a text with the measures that the user can try against the cause of a failed boot.
std::string remedy(const BusPlan& plan, const NodePlan& node, const BootFailure& failure);

/// A part of remedy(): says what the user can try when a device has answered a step of its boot
/// with an SDO abort code.
std::string against_abort(const NodePlan& node, const BootStep& step, const BootFailure& failure);

/// A part of remedy(): returns what the user can try when a device refuses an object that takt
/// writes by itself: the text names the key of the network file that governs the object. Returns an
/// empty text for other objects.
std::string against_refused_setting(const NodePlan& node, const BootFailure& failure);

}  // namespace takt
