#pragma once
#include <cmath>

namespace takt::sim {

/// Dry friction of one mass. An impulse takes speed from the mass, but never reverses it, so a mass
/// at rest stays at rest, with speed 0, until a larger torque breaks it away.
class Friction {
 public:
  /// `torque` is the friction in N m of a moving mass; at rest, the friction is `breakaway` times
  /// as large. `span` is the duration of a step in s, `inertia` is in kg m2.
  Friction(double torque, double breakaway, double span, double inertia) noexcept
      : sliding_{torque * span / inertia},
        at_rest_{sliding_ * breakaway},
        per_torque_{span / inertia} {}

  /// Returns the speed after a step. `before` is the speed before it, `speed` the speed that it
  /// would have without dry friction, `clamp` the torque of a brake on this mass.
  double slow(double before, double speed, double clamp = 0) const noexcept {
    const double most = (before == 0 ? at_rest_ : sliding_) + clamp * per_torque_ + creeping;
    if (std::abs(speed) <= most) return 0;
    return speed - std::copysign(most, speed);
  }

 private:
  static constexpr double creeping = 1e-12;  // rad/s, below which every mass is at rest

  double sliding_;  ///< decrease of the speed by friction in a step
  double at_rest_;
  double per_torque_;  ///< speed per torque
};

}  // namespace takt::sim
