#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Text of EventKind::axis_not_stopped without the node: "was disabled at 75 mm/s". Front side
/// only.
std::string axis_stop_text(const BusPlan& plan, const Event& event);
/// The same text with the name of the node: "z was disabled at 75 mm/s", "x: no answer for 1.2 s".
std::string named_axis_stop_text(const BusPlan& plan, const Event& event);
/// Text of EventKind::loss_reaction without the node.
std::string reaction_text(const Event& event);
/// Text of EventKind::drive_coasts without the node.
std::string coasting_text(const Event& event);
/// Text of EventKind::still_armed without the node.
std::string still_armed_text(const Event& event);

}  // namespace takt
