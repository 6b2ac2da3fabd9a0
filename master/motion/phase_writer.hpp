#pragma once
#include <cmath>

#include "master/motion/profile.hpp"

namespace takt::motion {

/// Appends phases to a profile and follows their acceleration exactly, in the units of Transfer.
/// Phases that must end with a certain acceleration get the duration that leads there from the
/// acceleration that all earlier phases have led to, so that their rounding does not add up: what
/// would be left of it changes the velocity of a long cruise, and the end.
class PhaseWriter {
 public:
  /// `acceleration` is that of the end of `profile`.
  PhaseWriter(Profile& profile, double jerk, long double acceleration) noexcept
      : profile_{profile}, jerk_{jerk}, acceleration_{acceleration} {}

  /// Appends a phase with jerk 1, 0 or -1. Rounding may have made its duration negative.
  void add(double duration, double jerk) noexcept {
    if (duration <= 0.0) return;
    profile_.add(duration, jerk * jerk_);
    acceleration_ += static_cast<long double>(jerk) * duration;
  }

  /// Appends the phase after which the acceleration is this one.
  void add_until(double acceleration) noexcept {
    const long double change = acceleration - acceleration_;
    add(static_cast<double>(std::abs(change)), change > 0.0L ? 1.0 : -1.0);
  }

  /// Appends a phase with a constant velocity. If the phase is long, `velocity`
  /// changes slightly, to compensate the rounding of the phase before it.
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
