#include "apps/move/set_points/following.hpp"

namespace takt {

Following::Following(Eigen::Index axes)
    : error_{Eigen::VectorXd::Zero(axes)}, largest_{Eigen::VectorXd::Zero(axes)} {}

void Following::sent(std::int64_t cycle, const Eigen::VectorXd& target) {
  if (cycle < 0) return;
  Target& place = targets_[static_cast<std::size_t>(cycle) % targets_.size()];
  place.cycle = cycle;
  place.position = target;
}

void Following::seen(std::int64_t cycle, const Eigen::VectorXd& position) {
  const std::int64_t origin = cycle - cycles_to_reach;
  if (origin < 0) return;
  const Target& target = targets_[static_cast<std::size_t>(origin) % targets_.size()];
  if (target.cycle != origin) return;
  error_ = position - target.position;
  largest_ = largest_.cwiseMax(error_.cwiseAbs());
  ++samples_;
}

}  // namespace takt
