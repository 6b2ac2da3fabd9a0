#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Nodes and SYNC as a whole: the network is ready, SYNC is lost ...
bool is_of_network(EventKind kind) noexcept;
/// What an event of the bus, of its SYNC or of the network as a whole says, without its subject.
std::string bus_event_text(const BusPlan& plan, const Event& event);

}  // namespace takt
