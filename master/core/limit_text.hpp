#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Bit of Event::detail of `limit_exceeded`: the command brought no set-point. It would have put
/// the one in force that was sent before, by enabling the axis or by changing its mode.
inline constexpr std::uint32_t held_set_point = 0x80;

/// The line for a `limit_exceeded` event: signal, measured value, its limit, and the command.
std::string limit_text(const BusPlan& plan, const Event& event);
/// The line for a `limit_read` event.
std::string read_limit_text(const BusPlan& plan, const Event& event);

}  // namespace takt
