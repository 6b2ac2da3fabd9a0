#pragma once

namespace takt {

/// Limits that a motion does not exceed, in the unit of the axis and in seconds. All are above
/// zero.
struct MotionLimits {
  double velocity = 1.0;
  double acceleration = 1.0;
  double jerk = 1.0;
};

}  // namespace takt
