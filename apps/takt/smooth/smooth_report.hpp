#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "apps/takt/smooth/judge/smooth_verdict.hpp"

namespace takt::smooth {

/// Returns the result for the user: a sentence, a table of figures, and the findings with their
/// remedies.
std::string verdict_text(const Verdict& verdict);

nlohmann::ordered_json verdict_json(const Verdict& verdict);

}  // namespace takt::smooth
