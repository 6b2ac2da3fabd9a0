#pragma once
#include <optional>
#include <string_view>

#include "eds_parser/table/time.hpp"

namespace takt {

/// `10s`, `500ms`, `250us`, `1.5min` or `1.5m`, `2h`, and `10`, which is seconds; at most 30 years.
std::optional<Time> parse_duration(std::string_view text) noexcept;

}  // namespace takt
