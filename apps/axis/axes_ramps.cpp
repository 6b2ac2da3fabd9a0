#include <algorithm>
#include <cmath>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/group/signal_format.hpp"

// The ramp of a stop in cyclic synchronous velocity mode, in which drives follow each target
// velocity at once.

namespace takt {

/// Reads the decelerations of stop(). A drive whose deceleration can't be read, or is 0, gets the
/// target velocity 0 at once.
void Axes::State::learn_decelerations() {
  decelerations_.setZero(size());
  for (Index i = 0; i < size(); ++i) {
    if (group.axes().mode(in_group(i)) != DriveMode::cyclic_velocity) continue;
    const auto counts = read_of_axis(in_group(i), profile_deceleration);
    const auto place = *group.axes().signals(in_group(i)).target_velocity;
    const double scale = std::abs(format_of(group.input().signals()[place]).scale);
    decelerations_(i) = scale * static_cast<double>(counts.value_or(0));
  }
}

/// Returns the newest target velocities that were sent to these axes.
Eigen::VectorXd Axes::State::sent_velocities() const {
  Eigen::VectorXd sent{Eigen::VectorXd::Zero(size())};
  for (Index i = 0; i < size(); ++i) {
    const auto place = group.axes().signals(in_group(i)).target_velocity;
    if (place) sent(i) = value_at(*place);
  }
  return sent;
}

/// Lowers the target velocities along the decelerations.
std::optional<Done> Axes::State::slow_down() {
  if (!has_set_points_ || decelerations_.isZero(0.0)) return Done{};
  Eigen::VectorXd velocities = sent_velocities();
  Eigen::VectorXd rates = decelerations_;
  const double longest = std::chrono::duration<double>(options.longest).count();
  for (Index i = 0; i < size(); ++i) {
    const bool ramps = rates(i) > 0.0 && group.axes().drive(in_group(i)).enabled();
    if (!ramps) velocities(i) = 0.0;
    rates(i) = std::max(rates(i), std::abs(velocities(i)) / longest);
  }
  const double period = std::chrono::duration<double>(group.period()).count();
  const std::int64_t begin = group.input().cycle();
  const auto is_slow = [&] {
    const double time = period * static_cast<double>(group.input().cycle() - begin);
    const Eigen::ArrayXd left = (velocities.array().abs() - rates.array() * time).max(0.0);
    group.axes().set_velocities(in_group(velocities.array().sign() * left, 0.0));
    return !has_set_points_ || left.isZero(0.0);
  };
  return wait_until(is_slow, 2 * options.longest, Interruption::ignored);
}

}  // namespace takt
