#pragma once
#include <cstdint>

namespace takt::soak {

/// What is known of a target position that has to be on a path.
enum class PathVerdict : std::uint8_t {
  on,       ///< the position is on the path
  off,      ///< the position is not on the path
  done,     ///< the position is the end of the path
  unknown,  ///< nothing can be said from now on
};

}  // namespace takt::soak
