#pragma once
#include <cstdint>
#include <type_traits>

#include "eds_parser/table/time.hpp"

namespace takt {

/// As time to live: the sender gives the output up in order; it takes its fallback at once.
inline constexpr std::uint32_t output_released = 0xFFFF'FFFF;

/// The newest command for one output, as the front thread left it.
struct SetPoint {
  std::int64_t value = 0;          ///< raw
  std::uint32_t generation = 0;    ///< another number with each command; 0: never commanded
  std::uint32_t time_to_live = 0;  ///< cycles; 0: the configured one
  Time when{};                     ///< its age was judged by the front thread
};
static_assert(sizeof(SetPoint) == 24 && std::is_trivially_copyable_v<SetPoint>);

}  // namespace takt
