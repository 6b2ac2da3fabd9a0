#pragma once
#include <cstdint>
#include <string_view>

#include "eds_parser/table/output_limits.hpp"

namespace takt {

/// As the keys of `limits:`.
std::string_view name(LimitKind kind) noexcept;
/// `file`, `device`, `none`.
std::string_view name(LimitSource source) noexcept;

/// What a device says of its range is a limit: it is neither empty nor the whole of an INTEGER16 or
/// INTEGER32.
constexpr bool plausible_range(std::int64_t low, std::int64_t high) noexcept {
  const bool whole16 = low <= -0x7FFF && high == 0x7FFF;
  const bool whole32 = low <= -0x7FFF'FFFFLL || high >= 0x7FFF'FFFFLL;
  return low < high && !whole16 && !whole32;
}

/// The same of a magnitude: neither 0 nor the highest value of its type.
constexpr bool plausible_size(std::int64_t value) noexcept {
  return value > 0 && value != 0xFFFF && value < 0x7FFF'FFFF;
}

}  // namespace takt
