#pragma once

namespace takt::motion {

/// A change from one velocity and acceleration to another, and the limits that apply meanwhile. All
/// quantities are divided by the jerk limit. The jerk is therefore 1, 0 or -1, accelerations are in
/// s, velocities in s^2 and distances in s^3. Both states must be inside the limits, see entry().
struct Transfer {
  double start_velocity = 0.0;
  double start_acceleration = 0.0;
  double end_velocity = 0.0;
  double end_acceleration = 0.0;
  double max_velocity = 0.0;
  double min_velocity = 0.0;
  double max_acceleration = 0.0;
  double min_acceleration = 0.0;
};

/// Returns the transfer of the mirrored axis.
constexpr Transfer mirrored(const Transfer& transfer) noexcept {
  return {.start_velocity = -transfer.start_velocity,
          .start_acceleration = -transfer.start_acceleration,
          .end_velocity = -transfer.end_velocity,
          .end_acceleration = -transfer.end_acceleration,
          .max_velocity = -transfer.min_velocity,
          .min_velocity = -transfer.max_velocity,
          .max_acceleration = -transfer.min_acceleration,
          .min_acceleration = -transfer.max_acceleration};
}

}  // namespace takt::motion
