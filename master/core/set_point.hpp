#pragma once
#include <cstdint>
#include <type_traits>

#include "eds_parser/values/time.hpp"

namespace takt {

/// This value of time_to_live means that the sender releases the output on purpose. The output then
/// takes its fallback at once.
inline constexpr std::uint32_t output_released = 0xFFFF'FFFF;

/// The newest command for one output. The front thread writes it.
struct SetPoint {
  std::int64_t value = 0;          ///< raw value of the object
  std::uint32_t generation = 0;    ///< changes with each command; 0 means never commanded
  std::uint32_t time_to_live = 0;  ///< cycles; 0 means the configured one
  Time when{};  ///< time at which the front thread has determined the age of the command
};
static_assert(sizeof(SetPoint) == 24 && std::is_trivially_copyable_v<SetPoint>);

}  // namespace takt
