#include "apps/move/synchronised_move.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace takt {
namespace {

/// Returns true if the motion ends elsewhere than at its target, because the limits are too far
/// apart for the planner.
bool misses(const motion::AxisTask& task, const motion::PlannedAxis& axis) noexcept {
  const double most = std::max(std::abs(task.from.position), std::abs(task.to.position));
  return !(std::abs(axis.profile.end(task.from).position - task.to.position) <= 1e-7 * most);
}

}  // namespace

std::optional<SynchronisedMove> SynchronisedMove::plan(const Eigen::VectorXd& from,
                                                       const Eigen::VectorXd& to,
                                                       std::span<const MotionLimits> limits) {
  SynchronisedMove move;
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const auto& [velocity, acceleration, jerk] = limits[static_cast<std::size_t>(i)];
    move.tasks_.push_back({.from = {.position = from(i)},
                           .to = {.position = to(i)},
                           .limits = {.max_velocity = velocity,
                                      .min_velocity = -velocity,
                                      .max_acceleration = acceleration,
                                      .min_acceleration = -acceleration,
                                      .jerk = jerk}});
  }
  move.planned_.resize(move.tasks_.size());
  const auto duration = motion::plan_trajectory(
      move.tasks_, {.synchronisation = motion::Synchronisation::phase}, move.planned_);
  if (!duration || !std::ranges::equal(move.tasks_, move.planned_, std::not_fn(misses))) {
    return std::nullopt;
  }
  move.duration_ = *duration;
  return move;
}

Eigen::VectorXd SynchronisedMove::position(double seconds) const {
  Eigen::VectorXd point{static_cast<Eigen::Index>(tasks_.size())};
  std::ranges::transform(tasks_, planned_, point.begin(),
                         [&](const motion::AxisTask& task, const auto& axis) {
                           if (seconds >= duration_) return task.to.position;
                           return axis.profile.at(task.from, std::max(seconds, 0.0)).position;
                         });
  return point;
}

}  // namespace takt
