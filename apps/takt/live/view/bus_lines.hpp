#pragma once
#include <cstddef>
#include <vector>

#include "apps/takt/live/text/line.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt {

// These functions make parts of the views of one bus whose status has come. No line is longer than
// `width` columns.

/// Returns the state of the bus, its load, and what is wrong with it.
std::vector<Line> bus_lines(const BusView& bus, std::size_t width);

/// Returns the counters of the bus, of its SYNC and of its cycle, and what the machine granted.
std::vector<Line> counter_lines(const BusView& bus, std::size_t width);

/// Returns the state of the ordered stop, or nothing while no stop is requested.
std::vector<Line> stop_lines(const status_t& status, std::size_t width);

}  // namespace takt
