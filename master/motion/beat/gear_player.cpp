#include "master/motion/beat/gear_player.hpp"

#include <algorithm>
#include <cmath>

namespace takt::motion {

void GearPlayer::begin(const GearTask& task, const Limits& limits) noexcept {
  *this = {};
  task_ = task;
  limits_ = limits;
  servo_ = GearServo{limits};
  phase_ = GearPhase::approaching;
  matched_ = task.match == PhaseMatch::at;
  offset_ = matched_ ? task.offset : 0.0;
}

State GearPlayer::step(const State& from, const LeaderState& leader, const LeaderSample& sample,
                       double elapsed, double period) noexcept {
  if (phase_ == GearPhase::released) {
    released_ = static_cast<std::uint8_t>(std::min(released_ + 1, most_released + 1));
    return released(from, period);
  }
  if (task_.kind == LeaderKind::commanded) {
    lost_ = leader.is_lost;
    return lost_ ? from : follow(from, leader, period);
  }
  estimate_.take(sample, task_, elapsed, period);
  lost_ = leader.is_lost || estimate_.is_lost();
  if (lost_) return from;
  if (!estimate_.is_ready()) return servo_.step_to_cruise(from, period);
  return follow(from, {.state = estimate_.state(task_)}, period);
}

/// Adds whole turns to the offset. A rotary leader counts from the start of its turn. A rotary axis
/// moves to the nearest position that has the phase of the gear.
void GearPlayer::choose_turns(const State& from, const State& leader) noexcept {
  if (task_.kind == LeaderKind::commanded && task_.modulo > 0.0) {
    offset_ -=
        task_.ratio * task_.modulo * std::floor((leader.position - task_.zero) / task_.modulo);
  }
  if (task_.turn > 0.0) {
    const double target = task_.ratio * leader.position + offset_;
    offset_ += task_.turn * std::floor((from.position - target) / task_.turn + 0.5);
  }
}

State GearPlayer::follow(const State& from, const LeaderState& leader, double time) noexcept {
  if (!started_ && matched_) choose_turns(from, leader.state);
  const double turned = task_.ratio * leader.state.position;
  const State target{.position = turned + offset_,
                     .velocity = task_.ratio * leader.state.velocity,
                     .acceleration = task_.ratio * leader.state.acceleration};
  const double jerk = started_ ? (target.acceleration - last_.acceleration) / time : 0.0;
  started_ = true;
  last_ = target;
  if (matched_) {
    const State next = servo_.step_to_position(from, target, jerk, time);
    judge(next, target, time);
    return next;
  }
  const State next = servo_.step_to_velocity(from, target, time);
  const double step = limits_.jerk * time;
  matched_ = std::abs(next.velocity - target.velocity) <= step * time &&
             std::abs(next.acceleration - target.acceleration) <= step;
  if (matched_) offset_ = next.position - turned;
  return next;
}

void GearPlayer::judge(const State& axis, const State& target, double time) noexcept {
  const double step = limits_.jerk * time;
  const double rounding = 1e-12 * std::abs(target.position);
  const double window = std::max(task_.lock_window, 2.0 * step * time * time) + rounding;
  error_ = axis.position - target.position;
  const bool was_locked = phase_ == GearPhase::locked;
  const double most = was_locked ? 4.0 * window : window;
  const bool is_locked =
      std::abs(error_) <= most &&
      (was_locked || std::abs(axis.velocity - target.velocity) <= 2.0 * step * time);
  phase_ = is_locked ? GearPhase::locked : GearPhase::approaching;
  locked_ = locked_ || is_locked;
}

bool GearPlayer::is_off() const noexcept {
  return locked_ && std::abs(error_) > task_.max_phase_error;
}

}  // namespace takt::motion
