#pragma once
#include <cmath>

#include "master/motion/profile.hpp"

namespace takt::motion {

/// Appends phases to a profile and computes the acceleration after each of them exactly, in the
/// units of Transfer. The duration of a phase that must end with a certain acceleration is computed
/// from the exact acceleration at its begin, so the rounding of earlier phases does not add up.
/// Without this, a small acceleration would remain, which changes the velocity of a long cruise and
/// the end of the motion.
class PhaseWriter {
 public:
  /// `acceleration` is the acceleration at the end of `profile`.
  PhaseWriter(Profile& profile, double jerk, long double acceleration) noexcept
      : profile_{profile}, jerk_{jerk}, acceleration_{acceleration} {}

  /// Appends a phase with jerk 1, 0 or -1. A duration that is negative because of rounding counts
  /// as 0.
  void add(double duration, double jerk) noexcept {
    if (duration <= 0.0) return;
    profile_.add(duration, jerk * jerk_);
    acceleration_ += static_cast<long double>(jerk) * duration;
  }

  /// Appends a phase that ends with this acceleration.
  void add_until(double acceleration) noexcept {
    const long double change = acceleration - acceleration_;
    add(static_cast<double>(std::abs(change)), change > 0.0L ? 1.0 : -1.0);
  }

  /// Appends a phase with a constant velocity. Before a long phase, a small acceleration that
  /// rounding has left is set to 0; this changes the velocity slightly. `velocity` is the size
  /// against which the effect of rounding is compared.
  void cruise(double duration, double velocity) noexcept {
    constexpr double tiny = 1e-14;
    if (std::abs(acceleration_) * duration > tiny * velocity) add_until(0.0);
    add(duration, 0.0);
  }

 private:
  Profile& profile_;
  double jerk_;
  long double acceleration_;
};

}  // namespace takt::motion
