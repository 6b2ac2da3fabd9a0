#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

// Texts of single events, without their subject. Front side only.

/// Describes an event of the bus, of its SYNC or of the network as a whole.
std::string bus_event_text(const BusPlan& plan, const Event& event);

/// Describes EventKind::limit_exceeded: signal, measured value, its limit, and the command.
std::string limit_text(const BusPlan& plan, const Event& event);
/// Describes EventKind::limit_read.
std::string read_limit_text(const BusPlan& plan, const Event& event);

/// Describes EventKind::axis_not_stopped: "was disabled at 75 mm/s".
std::string axis_stop_text(const BusPlan& plan, const Event& event);
/// Returns the text of axis_stop_text() with the name of the node: "z was disabled at 75 mm/s", "x:
/// no answer for 1.2 s".
std::string named_axis_stop_text(const BusPlan& plan, const Event& event);
/// Describes EventKind::loss_reaction.
std::string reaction_text(const Event& event);
/// Describes EventKind::drive_coasts.
std::string coasting_text(const Event& event);
/// Describes EventKind::still_armed.
std::string still_armed_text(const Event& event);

}  // namespace takt
