#include "apps/move/set_points/taken_set_points.hpp"

#include <algorithm>

namespace takt {

TakenSetPoints::TakenSetPoints(const Eigen::VectorXd& begin)
    : apart_{Eigen::VectorXd::Zero(begin.size())} {
  under_way_.front().shown = begin;
}

void TakenSetPoints::sent(double time, const Eigen::VectorXd& shown) {
  if (time <= under_way_[count_ - 1].time) return;
  if (count_ == most) {
    std::ranges::rotate(under_way_, under_way_.begin() + 1);
    --count_;
  }
  under_way_[count_++] = {.time = time, .shown = shown};
}

/// Looks for the nearest set-points, because a device may round the values that it shows. Among
/// equally near ones the newest counts.
void TakenSetPoints::seen(const Eigen::VectorXd& shown) {
  std::size_t nearest = 0;
  double distance = (under_way_[0].shown - shown).norm();
  for (std::size_t i = 1; i < count_; ++i) {
    const double other = (under_way_[i].shown - shown).norm();
    if (other > distance) continue;
    nearest = i;
    distance = other;
  }
  const auto taken = under_way_.begin() + static_cast<std::ptrdiff_t>(nearest);
  std::rotate(under_way_.begin(), taken, under_way_.begin() + static_cast<std::ptrdiff_t>(count_));
  count_ -= nearest;
  apart_ = (under_way_.front().shown - shown).cwiseAbs();
  time_ = under_way_.front().time;
}

}  // namespace takt
