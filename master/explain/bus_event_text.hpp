#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Returns true for events of the network as a whole: the network is ready, SYNC is lost ...
bool is_of_network(EventKind kind) noexcept;
/// Describes an event of the bus, of its SYNC or of the network as a whole, without its subject.
std::string bus_event_text(const BusPlan& plan, const Event& event);

}  // namespace takt
