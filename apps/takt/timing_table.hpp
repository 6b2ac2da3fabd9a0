#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "master/gateway/messages.hpp"

namespace takt {

/// What a histogram of timing_t is of: "SYNC late by"; else its name.
std::string_view timing_label(std::string_view histogram);

/// A row for each histogram with its distribution as a picture; nothing was timed: says so.
std::vector<std::string> timing_lines(const timing_t& timing);

/// All that the message holds, times in microseconds.
nlohmann::json timing_json(const timing_t& timing);

}  // namespace takt
