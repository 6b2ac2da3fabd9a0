#pragma once
#include <optional>
#include <string_view>

#include "eds_parser/table/time.hpp"

namespace takt {

/// `10s`, `500ms`, `250us`, `1.5min`, `2h`; at most 10,000 hours. A number alone is none.
std::optional<Time> parse_duration(std::string_view text) noexcept;

}  // namespace takt
