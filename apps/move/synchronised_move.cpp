#include "apps/move/synchronised_move.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace takt {
namespace {

/// Returns the profile of the covered share of the way, 0 to 1. Its limits keep every axis within
/// the limits of that axis.
JerkLimited profile_of(const Eigen::VectorXd& way, std::span<const MotionLimits> limits) {
  constexpr double none = std::numeric_limits<double>::infinity();
  MotionLimits strictest{.velocity = none, .acceleration = none, .jerk = none};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double distance = std::abs(way(static_cast<Eigen::Index>(i)));
    if (distance == 0.0) continue;
    strictest.velocity = std::min(strictest.velocity, limits[i].velocity / distance);
    strictest.acceleration = std::min(strictest.acceleration, limits[i].acceleration / distance);
    strictest.jerk = std::min(strictest.jerk, limits[i].jerk / distance);
  }
  return {way.isZero(0.0) ? 0.0 : 1.0, strictest};
}

}  // namespace

SynchronisedMove::SynchronisedMove(Eigen::VectorXd from, Eigen::VectorXd to,
                                   std::span<const MotionLimits> limits)
    : from_{std::move(from)}, to_{std::move(to)}, profile_{profile_of(to_ - from_, limits)} {}

Eigen::VectorXd SynchronisedMove::position(double seconds) const {
  if (seconds >= duration()) return to_;
  return from_ + (to_ - from_) * profile_.at(seconds).position;
}

Eigen::VectorXd SynchronisedMove::velocity(double seconds) const {
  if (seconds >= duration()) return Eigen::VectorXd::Zero(to_.size());
  return (to_ - from_) * profile_.at(seconds).velocity;
}

}  // namespace takt
