#include "apps/move/set_points/synchronised_move.hpp"

#include <algorithm>

namespace takt {
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
  if (!duration) return std::nullopt;
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
