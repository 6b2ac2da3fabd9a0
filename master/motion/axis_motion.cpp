#include "master/motion/axis_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "master/motion/cruise.hpp"

namespace takt::motion {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Transfer transfer_of(const State& from, const State& to, const Limits& limits) noexcept {
  return {.start_velocity = from.velocity / limits.jerk,
          .start_acceleration = from.acceleration / limits.jerk,
          .end_velocity = to.velocity / limits.jerk,
          .end_acceleration = to.acceleration / limits.jerk,
          .max_velocity = limits.max_velocity / limits.jerk,
          .min_velocity = limits.min_velocity / limits.jerk,
          .max_acceleration = limits.max_acceleration / limits.jerk,
          .min_acceleration = limits.min_acceleration / limits.jerk};
}

bool is_at_target(const State& from, const State& to, const Limits& limits, Goal goal) noexcept {
  const double velocity = limits.max_velocity - limits.min_velocity;
  const double acceleration = limits.max_acceleration - limits.min_acceleration;
  const bool rests = to.velocity == 0.0 && to.acceleration == 0.0;
  const double position = (rests ? AxisMotion::at_rest_position : AxisMotion::at_target_position) *
                          std::max(std::abs(from.position), std::abs(to.position));
  const auto same = [](double a, double b, double size) { return std::abs(a - b) <= size; };
  return same(from.velocity, to.velocity, AxisMotion::at_target * velocity) &&
         same(from.acceleration, to.acceleration, AxisMotion::at_target * acceleration) &&
         (goal == Goal::velocity || same(from.position, to.position, position));
}

State after(const Entry& entry, const State& from, double jerk) noexcept {
  if (entry.jerk == 0.0) return from;
  return advanced(advanced(from, entry.duration, entry.jerk * jerk), entry.hold, 0.0);
}

/// Returns the duration at which `motion` reaches `distance`. The motion reaches it with the
/// duration `high`, but not with `low`; in between, the distance is a convex or concave function of
/// the duration. `start` must be `low` or `high`: the one from which Newton's method approaches the
/// solution without passing it. If a step leaves the bracket because of rounding, the bracket is
/// halved instead.
double crossing(const FarthestMotion& motion, double distance, double low, double high,
                double start) noexcept {
  double time = start;
  double last_step = high - low;
  for (int i = 0; i < 60; ++i) {
    const auto reached = motion.reach(time);
    const double error = reached.distance - distance;
    if (error == 0.0) break;
    (error > 0.0 ? high : low) = time;
    double next = time - error / reached.slope;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    // Steps that no longer become smaller are caused only by the rounding of the distance.
    const double step = std::abs(next - time);
    if (step <= 2 * epsilon * time || (step >= last_step && step < 1e-11 * time)) break;
    last_step = step;
    time = next;
  }
  return time;
}

/// Returns the duration between `low` and `high` with the greatest distance. The distance must be a
/// concave function of the duration there.
double summit(const FarthestMotion& motion, double low, double high) noexcept {
  for (int i = 0; i < 60 && high - low > epsilon * high; ++i) {
    const double middle = (low + high) / 2;
    (motion.reach(middle).slope > 0.0 ? low : high) = middle;
  }
  return low;
}

/// Returns the shortest duration between `first` and `last` with which `motion` reaches `distance`.
/// The motion must not reach it with `first`; `last` may be infinite. If a motion falls short of
/// `distance` at a summit or at `last` by `tolerance` or less, the difference counts as rounding,
/// and the motion reaches `distance`. Returns std::nullopt if there is no such duration.
std::optional<double> time_to_reach(const FarthestMotion& motion, double distance, double first,
                                    double last, double tolerance) noexcept {
  double low = first;
  const double bent = std::min(last, motion.cruises_after());
  for (const double bend : motion.bends()) {
    const double high = std::min(bend, bent);
    if (high <= low) continue;
    const auto end = motion.reach(high);
    // A motion that passes its target and returns to it reaches it for the first time before its
    // summit.
    if (end.slope < 0.0 && motion.reach(low).slope > 0.0) {
      const double top = summit(motion, low, high);
      const double most = motion.reach(top).distance;
      if (most >= distance) return crossing(motion, distance, low, top, low);
      if (most >= distance - tolerance) return top;
    }
    if (end.distance >= distance) return crossing(motion, distance, low, high, high);
    low = high;
  }
  const double high = std::max(low, bent);
  const auto end = motion.reach(high);
  if (end.distance >= distance) return crossing(motion, distance, low, high, high);
  if (high < last) {  // the axis cruises
    const double time = high + (distance - end.distance) / end.slope;
    if (time <= last) return time;
  }
  if (motion.reach(last).distance >= distance - tolerance) return last;
  return std::nullopt;
}

/// The jerks of the seven phases of a farthest motion.
constexpr std::array phase_jerks{1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0};

/// Appends the weighted mean of two motions that run at the same time: `up` with `weight`, and
/// `down`, which is a motion of the mirrored axis, with 1 - `weight`.
void add_mixture(const Phases& up, const Phases& down, double weight, double jerk,
                 Profile& profile) noexcept {
  std::size_t i = 0;
  std::size_t j = 0;
  double left_up = up[0];
  double left_down = down[0];
  while (i < up.size() && j < down.size()) {
    const double step = std::min(left_up, left_down);
    profile.add(step, jerk * (weight * phase_jerks[i] - (1.0 - weight) * phase_jerks[j]));
    left_up -= step;
    left_down -= step;
    if (left_up <= 0.0 && ++i < up.size()) left_up = up[i];
    if (left_down <= 0.0 && ++j < down.size()) left_down = down[j];
  }
}

}  // namespace

AxisMotion::AxisMotion(const State& from, const State& to, const Limits& limits, Goal goal) noexcept
    : jerk_{limits.jerk},
      entry_{entry(transfer_of(from, to, limits))},
      entry_time_{entry_.duration + entry_.hold},
      transfer_{transfer_of(after(entry_, from, jerk_), to, limits)},
      entered_{from.acceleration / static_cast<long double>(jerk_) +
               static_cast<long double>(entry_.jerk) * entry_.duration},
      distance_{(to.position - after(entry_, from, jerk_).position) / jerk_},
      goal_{goal},
      at_target_{is_at_target(from, to, limits, goal)},
      times_{transfer_},
      up_{transfer_},
      down_{mirrored(transfer_)} {}

/// Appends the phases of a farthest motion.
void AxisMotion::add_phases(const Phases& phases, double direction,
                            PhaseWriter& writer) const noexcept {
  const bool cruises = phases[3] > 0.0;
  writer.add(phases[0], direction);
  writer.add(phases[1], 0.0);
  if (cruises) {
    writer.add_until(0.0);
    writer.cruise(phases[3], transfer_.max_velocity);
  } else {
    writer.add(phases[2], -direction);
  }
  writer.add(phases[4], -direction);
  writer.add(phases[5], 0.0);
  writer.add_until(transfer_.end_acceleration);
}

double AxisMotion::rounding(double time) const noexcept {
  const double acceleration =
      std::min(transfer_.max_acceleration - transfer_.min_acceleration, time);
  const double velocity =
      std::abs(transfer_.start_velocity) + std::abs(transfer_.end_velocity) +
      std::min(transfer_.max_velocity - transfer_.min_velocity, time * acceleration);
  return 16 * epsilon * time * velocity;
}

double AxisMotion::possible(double duration) const noexcept {
  if (at_target_ && duration <= 0.0) return 0.0;
  const double wanted = duration - entry_time_;
  for (const TimeRange& range : times_.ranges()) {
    if (wanted > range.last) continue;
    const double time = std::max(wanted, range.first);
    if (goal_ == Goal::velocity) return entry_time_ + time;
    const auto reach = [&](const FarthestMotion& motion, double distance) {
      const double longest = std::max(time, std::min(range.last, motion.cruises_after()));
      return time_to_reach(motion, distance, time, range.last, rounding(longest));
    };
    const double tolerance = rounding(time);
    std::optional<double> reached = time;
    if (distance_ > distance_up(time) + tolerance) {
      reached = reach(up_, distance_);
    } else if (distance_ < distance_down(time) - tolerance) {
      reached = reach(down_, -distance_);
    }
    if (reached) return entry_time_ + *reached;
  }
  return std::numeric_limits<double>::infinity();  // This line is never reached, because the last
                                                   // range has no end.
}

Profile AxisMotion::profile(double duration) const noexcept {
  Profile profile;
  if (duration <= 0.0) return profile;
  profile.add(entry_.duration, entry_.jerk * jerk_);
  profile.add(entry_.hold, 0.0);
  PhaseWriter writer{profile, jerk_, entered_};
  const double time = duration - entry_time_;
  const double highest = distance_up(time);
  const double lowest = distance_down(time);
  const double distance = goal_ == Goal::position ? distance_ : (highest + lowest) / 2;
  const double tolerance = rounding(time);
  if (distance >= highest - tolerance) {
    add_phases(up_.phases(time), 1.0, writer);
    return profile;
  }
  if (distance <= lowest + tolerance) {
    add_phases(down_.phases(time), -1.0, writer);
    return profile;
  }
  if (up_.rises_and_falls(time) && down_.rises_and_falls(time)) {
    const auto cruise =
        find_cruise(transfer_, time, distance, -down_.peak_velocity(time), up_.peak_velocity(time));
    if (cruise) {
      add_cruise(transfer_, *cruise, writer);
      return profile;
    }
  }
  const double weight = (distance - lowest) / (highest - lowest);
  add_mixture(up_.phases(time), down_.phases(time), weight, jerk_, profile);
  return profile;
}

}  // namespace takt::motion
