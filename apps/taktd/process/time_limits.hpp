#pragma once
#include "eds_parser/values/time.hpp"

namespace takt {

// Time limits for the last writes to the files and to stderr. A stuck disk must not keep the daemon
// from ending.
inline constexpr Time last_recording = std::chrono::seconds{2};
inline constexpr Time last_lines = std::chrono::seconds{2};

}  // namespace takt
