#include "master/motion/farthest_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt::motion {
namespace {

double square(double value) noexcept { return value * value; }

/// Returns the values in ascending order, after a number of instructions that does not depend on
/// them. A NaN is not lost, but may be at any place of the result.
std::array<double, 4> sorted(std::array<double, 4> values) noexcept {
  constexpr std::array<std::array<std::size_t, 2>, 5> pairs{
      {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}}};
  for (const auto& [low, high] : pairs) {
    // Both lines compare `high` with `low`. If one of the two is NaN, they thus stay in place.
    const double less = std::min(values[low], values[high]);
    values[high] = std::max(values[high], values[low]);
    values[low] = less;
  }
  return values;
}

/// A change of the velocity to a higher one, at whose end the acceleration is 0. `peak` is the
/// greatest acceleration, `hold` the time for which the axis keeps it.
struct Rise {
  double peak = 0.0;
  double hold = 0.0;
};
Rise rise_to(double rise, double acceleration, double limit) noexcept {
  const double needed = std::max(rise + square(acceleration) / 2, 0.0);
  const double peak = std::sqrt(needed);
  if (peak <= limit) return {.peak = std::max(peak, acceleration), .hold = 0.0};
  return {.peak = limit, .hold = (needed - square(limit)) / limit};
}

/// Returns the distance of a motion that starts with this velocity and acceleration.
double distance(const Phases& phases, double velocity, double acceleration) noexcept {
  static constexpr std::array jerks{1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0};
  double position = 0.0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double t = phases[i];
    position += t * (velocity + t * (acceleration / 2 + t * jerks[i] / 6));
    velocity += t * (acceleration + t * jerks[i] / 2);
    acceleration += t * jerks[i];
  }
  return position;
}

}  // namespace

FarthestMotion::FarthestMotion(const Transfer& transfer) noexcept
    : transfer_{transfer},
      gain_{transfer.end_velocity - transfer.start_velocity +
            (square(transfer.start_acceleration) - square(transfer.end_acceleration)) / 2} {
  const Rise up = rise_to(transfer.max_velocity - transfer.start_velocity,
                          transfer.start_acceleration, transfer.max_acceleration);
  // A fall of the velocity is a rise backwards in time.
  const Rise down = rise_to(transfer.max_velocity - transfer.end_velocity,
                            -transfer.end_acceleration, -transfer.min_acceleration);
  cruise_ = {up.peak - transfer.start_acceleration, up.hold, up.peak, 0.0, down.peak, down.hold,
             down.peak + transfer.end_acceleration};
  for (const double phase : cruise_) cruises_after_ += phase;
  cruise_distance_ = distance(cruise_, transfer.start_velocity, transfer.start_acceleration);
}

FarthestMotion::Fall FarthestMotion::fall(double duration) const noexcept {
  const double start = transfer_.start_acceleration;
  const double end = transfer_.end_acceleration;
  const double highest = transfer_.max_acceleration;
  const double lowest = transfer_.min_acceleration;
  // If no acceleration is held, the difference of the two accelerations follows from the duration,
  // and their sum from the velocities.
  const double twice = duration + start - end;
  double difference = std::max(twice / 2, 0.0);
  const double least = 2 * start - difference;
  const double most = std::max(2 * end + difference, least);
  const double sum = std::clamp(difference > 0.0 ? gain_ / difference : least, least, most);
  Fall fall{.from = (sum + difference) / 2, .to = (sum - difference) / 2};
  if (fall.from <= highest && fall.to >= lowest) return fall;
  // Otherwise at least one of the two accelerations is held at its limit for the rest of the
  // duration.
  const auto left = [&](double from, double to) { return std::max(twice - 2 * (from - to), 0.0); };
  fall.from = lowest + std::sqrt(std::max(gain_ - lowest * twice, 0.0));
  if (fall.to < lowest && fall.from <= highest) {
    return {.from = fall.from, .to = lowest, .hold_after = left(fall.from, lowest)};
  }
  fall.to = highest - std::sqrt(std::max(highest * twice - gain_, 0.0));
  if (fall.to >= lowest) {
    return {.from = highest, .to = fall.to, .hold_before = left(highest, fall.to)};
  }
  const double hold = left(highest, lowest);
  const double gain = gain_ - square(highest) + square(lowest);
  const double before = std::clamp((gain - lowest * hold) / (highest - lowest), 0.0, hold);
  return {.from = highest, .to = lowest, .hold_before = before, .hold_after = hold - before};
}

double FarthestMotion::velocity_before(const Fall& fall) const noexcept {
  return transfer_.start_velocity + (square(fall.from) - square(transfer_.start_acceleration)) / 2 +
         fall.from * fall.hold_before;
}

FarthestMotion::Reach FarthestMotion::reach(double duration) const noexcept {
  if (duration >= cruises_after_) {
    return {.distance = cruise_distance_ + transfer_.max_velocity * (duration - cruises_after_),
            .slope = transfer_.max_velocity};
  }
  const Fall parts = fall(duration);
  const double rise = std::max(parts.from - transfer_.start_acceleration, 0.0);
  const double length = parts.from - parts.to;
  const double end = std::max(transfer_.end_acceleration - parts.to, 0.0);
  const double start = transfer_.start_velocity;
  const double before = velocity_before(parts);
  const double after = before + length * (parts.from + parts.to) / 2 + parts.to * parts.hold_after;
  const double way = rise * (start + rise * (transfer_.start_acceleration / 2 + rise / 6)) +
                     parts.hold_before * (before - parts.from * parts.hold_before / 2) +
                     length * (before + length * (parts.from / 2 - length / 6)) +
                     parts.hold_after * (after - parts.to * parts.hold_after / 2) +
                     end * (after + end * (parts.to / 2 + end / 6));
  // By Pontryagin's principle, the slope can be computed from the state at any moment of the
  // motion. The formula is shortest at the start of the fall.
  return {.distance = way, .slope = before + parts.from * length / 2};
}

Phases FarthestMotion::phases(double duration) const noexcept {
  if (duration >= cruises_after_) {
    Phases phases = cruise_;
    phases[3] = duration - cruises_after_;
    return phases;
  }
  const Fall parts = fall(duration);
  return {std::max(parts.from - transfer_.start_acceleration, 0.0),
          parts.hold_before,
          parts.from - parts.to,
          0.0,
          0.0,
          parts.hold_after,
          std::max(transfer_.end_acceleration - parts.to, 0.0)};
}

std::array<double, 4> FarthestMotion::bends() const noexcept {
  // A bend is a duration at which the derivative of the slope changes its sign. Let u be the length
  // of the fall and K the gain. If no acceleration is held, the derivative has the sign of
  // 3 u^2 - K^2 / u^2. If the acceleration a is held before or after the fall, the derivative has
  // the sign of 4 u - 3 a.
  const double size = std::abs(gain_);
  const double limit = gain_ > 0.0 ? transfer_.max_acceleration : -transfer_.min_acceleration;
  const double root = std::sqrt(std::max(square(limit) - size, 0.0));
  const auto time = [&](double twice) {
    return twice - transfer_.start_acceleration + transfer_.end_acceleration;
  };
  return sorted({time(2 * std::sqrt(size / std::numbers::sqrt3)), time(2 * (limit - root)),
                 time(2 * (limit + root)), time((square(0.75 * limit) + size) / limit)});
}

bool FarthestMotion::rises_and_falls(double duration) const noexcept {
  if (duration >= cruises_after_) return true;
  const Fall parts = fall(duration);
  return parts.from >= 0.0 && parts.to <= 0.0;
}

double FarthestMotion::peak_velocity(double duration) const noexcept {
  if (duration >= cruises_after_) return transfer_.max_velocity;
  const Fall parts = fall(duration);
  return velocity_before(parts) + square(parts.from) / 2;
}

}  // namespace takt::motion
