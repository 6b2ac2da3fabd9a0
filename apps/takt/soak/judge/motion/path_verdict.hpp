#pragma once
#include <cstdint>

namespace takt::soak {

/// The result of comparing a target position with its path.
enum class PathVerdict : std::uint8_t {
  on,       ///< the position is on the path
  off,      ///< the position is not on the path
  done,     ///< the position is the end of the path
  unknown,  ///< from now on, the position can't be judged
};

}  // namespace takt::soak
