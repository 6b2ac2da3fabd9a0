#pragma once
#include <string>

namespace takt {

/// Shortest durations of the parts of a motion, in seconds. 0 means that the motion does not have
/// this part.
struct MotionTime {
  double move = 0.0;  ///< the move to the point
  double sine = 0.0;  ///< one period of the sine
};

/// Returns a sentence about a motion that does not end within `limit` seconds. The sentence is
/// empty if the motion fits.
std::string too_long(const MotionTime& time, double limit);

}  // namespace takt
