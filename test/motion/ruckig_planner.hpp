#pragma once
#include <array>
#include <exception>
#include <ruckig/ruckig.hpp>
#include <vector>

#include "master/motion/trajectory.hpp"

namespace takt::motion {

/// Plans the motion of one axis with ruckig, another motion planner.
class RuckigPlanner {
 public:
  using Trajectory = ruckig::Trajectory<1>;

  /// Returns false if ruckig finds no motion or throws. It may also crash.
  bool plan(const AxisTask& task, Trajectory& trajectory) {
    const Limits& limits = task.limits;
    input_.current_position = {task.from.position};
    input_.current_velocity = {task.from.velocity};
    input_.current_acceleration = {task.from.acceleration};
    input_.target_position = {task.to.position};
    input_.target_velocity = {task.to.velocity};
    input_.target_acceleration = {task.to.acceleration};
    input_.max_velocity = {limits.max_velocity};
    input_.min_velocity = std::array{limits.min_velocity};
    input_.max_acceleration = {limits.max_acceleration};
    input_.min_acceleration = std::array{limits.min_acceleration};
    input_.max_jerk = {limits.jerk};
    try {
      const auto result = planner_.calculate(input_, trajectory);
      return result == ruckig::Result::Working || result == ruckig::Result::Finished;
    } catch (const std::exception&) {
      return false;
    }
  }

 private:
  ruckig::Ruckig<1> planner_;
  ruckig::InputParameter<1> input_;
};

inline std::vector<Segment> segments_of(const RuckigPlanner::Trajectory& trajectory) {
  const auto profiles = trajectory.get_profiles();
  const ruckig::Profile& profile = profiles[0][0];
  std::vector<Segment> found;
  for (std::size_t i = 0; i < profile.brake.t.size(); ++i) {
    found.push_back({.duration = profile.brake.t[i], .jerk = profile.brake.j[i]});
  }
  for (std::size_t i = 0; i < profile.t.size(); ++i) {
    found.push_back({.duration = profile.t[i], .jerk = profile.j[i]});
  }
  return found;
}

}  // namespace takt::motion
