#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/plan/pdo/cob_ids.hpp"

namespace takt {

struct NumberRange;

/// Returns the content of the device data entry of a node as lines for people. The result is empty
/// if the node has no entry.
std::vector<std::string> device_notes(const NodePdos& node);

/// Returns the ranges as text: "1..240, 254, 255".
std::string list_of(const std::vector<NumberRange>& ranges);
/// Returns a time in microseconds as text: "50 ms", "100 us".
std::string time_text(std::uint64_t us);

}  // namespace takt
