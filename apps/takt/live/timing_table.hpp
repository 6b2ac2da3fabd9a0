#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "master/lcm/messages.hpp"

namespace takt {

/// Returns the label of a histogram of timing_t, for example "SYNC late by". An unknown histogram
/// keeps its name.
std::string_view timing_label(std::string_view histogram);

/// Returns a row for each histogram with its distribution as a bar chart, or a line that says that
/// nothing was measured.
std::vector<std::string> timing_lines(const timing_t& timing);

/// Returns the whole message, with times in microseconds.
nlohmann::json timing_json(const timing_t& timing);

}  // namespace takt
