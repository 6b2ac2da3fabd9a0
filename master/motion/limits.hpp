#pragma once

namespace takt::motion {

/// Limits of one axis, in the length unit of the caller and in seconds. A motion may reach each
/// limit but not exceed it.
struct Limits {
  double max_velocity = 0.0;      ///< greater than 0
  double min_velocity = 0.0;      ///< less than 0
  double max_acceleration = 0.0;  ///< greater than 0
  double min_acceleration = 0.0;  ///< less than 0
  double jerk = 0.0;              ///< greater than 0, for both directions

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(max_velocity, min_velocity, max_acceleration, min_acceleration, jerk);
  }
};

/// Returns the limits of the mirrored axis, whose positive direction is the negative one of this
/// axis.
constexpr Limits mirrored(const Limits& limits) noexcept {
  return {.max_velocity = -limits.min_velocity,
          .min_velocity = -limits.max_velocity,
          .max_acceleration = -limits.min_acceleration,
          .min_acceleration = -limits.max_acceleration,
          .jerk = limits.jerk};
}

}  // namespace takt::motion
