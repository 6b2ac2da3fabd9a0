#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Reads a duration: a number with a unit, such as `10s`, `500ms`, `250us`, `50ns`, `1.5min`,
/// `1.5m` or `2h`. A number without a unit means seconds. Returns std::nullopt if the text is no
/// duration or more than 1e18 ns (about 31 years).
std::optional<Time> parse_duration(std::string_view text) noexcept;

/// Returns the reason why an option refuses a text as a duration, or an empty string.
std::string duration_error(const std::string& text);

}  // namespace takt
