#pragma once
#include <cstdint>
#include <type_traits>

namespace takt {

/// What is known of one TPDO. Trivially copyable: it crosses threads.
struct PdoStatus {
  std::uint32_t received = 0;       ///< frames taken over
  std::uint32_t missing = 0;        ///< times it was expected and stayed away
  std::uint32_t length_errors = 0;  ///< frames shorter (ignored) or longer than the mapping
  std::uint32_t age = 0;            ///< SYNCs since the newest frame
  bool stale = true;                ///< not arrived when expected, or not at all so far
};
static_assert(std::is_trivially_copyable_v<PdoStatus>);

}  // namespace takt
