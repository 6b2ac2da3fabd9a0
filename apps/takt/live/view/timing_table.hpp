#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/live/text/line.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

/// Returns the label of a histogram of timing_t, for example "SYNC late by". An unknown histogram
/// keeps its name.
std::string_view timing_label(std::string_view histogram);

/// Returns a row for each histogram with its distribution as a bar chart, or a line that says that
/// nothing was measured. No line is longer than `width` columns.
std::vector<Line> timing_lines(const timing_t& timing, std::size_t width);

/// Returns the whole message, with times in microseconds.
nlohmann::json timing_json(const timing_t& timing);

}  // namespace takt
