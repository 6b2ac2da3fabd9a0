#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// The line of a `limit_exceeded` event: signal, what was measured, its limit, what was commanded.
std::string limit_text(const BusPlan& plan, const Event& event);
/// The line of a `limit_read` event.
std::string read_limit_text(const BusPlan& plan, const Event& event);

}  // namespace takt
