#include "apps/move/synchronised_move.hpp"

#include <utility>

namespace takt {

SynchronisedMove::SynchronisedMove(Eigen::VectorXd from, Eigen::VectorXd to,
                                   const MotionLimits& limits)
    : from_{std::move(from)},
      to_{std::move(to)},
      longest_{from_.size() == 0 ? 0.0 : (to_ - from_).cwiseAbs().maxCoeff()},
      profile_{longest_, limits} {}

Eigen::VectorXd SynchronisedMove::position(double seconds) const {
  if (seconds >= duration()) return to_;
  return from_ + (to_ - from_) * (profile_.at(seconds).position / longest_);
}

Eigen::VectorXd SynchronisedMove::velocity(double seconds) const {
  if (seconds >= duration()) return Eigen::VectorXd::Zero(to_.size());
  return (to_ - from_) * (profile_.at(seconds).velocity / longest_);
}

}  // namespace takt
