#pragma once
#include <cstdint>
#include <string_view>

#include "eds_parser/table/output_limits.hpp"

namespace takt {

/// Returns the key of the limit in `limits:` of the network file.
std::string_view name(LimitKind kind) noexcept;
/// Returns `file`, `device` or `none`.
std::string_view name(LimitSource source) noexcept;

/// Whether this end of a range of INTEGER32 bounds nothing, because it is the end of the type.
constexpr bool open_end(std::int64_t end) noexcept {
  return end <= -0x7FFF'FFFFLL || end >= 0x7FFF'FFFFLL;
}

/// Whether the range that a device reports is a real limit. It is none if it is empty, or covers
/// the whole of an INTEGER16 or INTEGER32. One end may be open.
constexpr bool plausible_range(std::int64_t low, std::int64_t high) noexcept {
  const bool whole16 = low <= -0x7FFF && high == 0x7FFF;
  return low < high && !whole16 && !(open_end(low) && open_end(high));
}

/// Whether a reported magnitude is a real limit. It is none if it is 0 or the highest value of a
/// type (0xFFFF, or 0x7FFF'FFFF and above).
constexpr bool plausible_size(std::int64_t value) noexcept {
  return value > 0 && value != 0xFFFF && value < 0x7FFF'FFFF;
}

}  // namespace takt
