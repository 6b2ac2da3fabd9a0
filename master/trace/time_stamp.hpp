#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt {

/// Converts the time stamp of a recorded line, such as `1436509052.249713` or
/// `2015-07-10 08:17:32.249713`, to microseconds. Returns std::nullopt if the text is no time.
std::optional<std::int64_t> stamp_in_us(std::string_view stamp);

}  // namespace takt
