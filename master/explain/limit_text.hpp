#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// The line for a `limit_exceeded` event: signal, measured value, its limit, and the command.
std::string limit_text(const BusPlan& plan, const Event& event);
/// The line for a `limit_read` event.
std::string read_limit_text(const BusPlan& plan, const Event& event);

}  // namespace takt
