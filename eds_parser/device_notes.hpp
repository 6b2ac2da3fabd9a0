#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/cob_ids.hpp"

namespace takt {

struct NumberRange;

/// What the entry of a node says, a line each, for people; empty where there is no entry.
std::vector<std::string> device_notes(const NodePdos& node);

/// "1..240, 254, 255".
std::string list_of(const std::vector<NumberRange>& ranges);
/// "50 ms", "100 us".
std::string time_text(std::uint64_t us);

}  // namespace takt
