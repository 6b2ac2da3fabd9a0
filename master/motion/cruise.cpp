#include "master/motion/cruise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace takt::motion {
namespace {

/// The fastest change from one velocity and acceleration to another velocity with the acceleration
/// 0. It has three phases with the jerks `sign`, 0 and -`sign`.
struct Change {
  double sign = 1.0;
  std::array<double, 3> phases{};
  double distance = 0.0;

  double duration() const noexcept { return phases[0] + phases[1] + phases[2]; }
};

Change change_to(double target, double velocity, double acceleration, double max_acceleration,
                 double min_acceleration) noexcept {
  Change change;
  const double natural = velocity + acceleration * std::abs(acceleration) / 2;
  change.sign = target >= natural ? 1.0 : -1.0;
  const double v = change.sign * velocity;
  const double a = change.sign * acceleration;
  const double limit = target >= natural ? max_acceleration : -min_acceleration;
  const double needed = std::max(change.sign * target - v + a * a / 2, 0.0);
  const double peak = std::sqrt(needed);
  const double held = std::max(std::min(peak, limit), a);
  const double hold = peak > limit ? (needed - limit * limit) / limit : 0.0;
  const double rise = held - a;
  change.phases = {rise, hold, held};
  const double before = v + rise * (a + rise / 2);
  const double after = before + hold * held;
  change.distance =
      change.sign * (rise * (v + rise * (a / 2 + rise / 6)) + hold * (before + hold * held / 2) +
                     held * (after + held * held / 3));
  return change;
}

Change begin_of(const Transfer& t, double velocity) noexcept {
  return change_to(velocity, t.start_velocity, t.start_acceleration, t.max_acceleration,
                   t.min_acceleration);
}

/// Returns the phases after the cruise in reverse order: the change from the end state, with its
/// acceleration negated, to the velocity of the cruise.
Change end_of(const Transfer& t, double velocity) noexcept {
  return change_to(velocity, t.end_velocity, -t.end_acceleration, -t.min_acceleration,
                   -t.max_acceleration);
}

}  // namespace

std::optional<Cruise> find_cruise(const Transfer& transfer, double duration, double distance,
                                  double lowest, double highest) noexcept {
  struct Trial {
    double velocity;
    double hold;
    double error;
  };
  const auto trial = [&](double velocity) {
    const Change begin = begin_of(transfer, velocity);
    const Change end = end_of(transfer, velocity);
    const double hold = duration - begin.duration() - end.duration();
    return Trial{velocity, hold, begin.distance + end.distance + velocity * hold - distance};
  };
  // An axis that is at rest at its target keeps its exact position. The search below would add
  // rounding.
  if (lowest <= 0.0 && highest >= 0.0) {
    const Trial still = trial(0.0);
    if (still.error == 0.0 && still.hold >= 0.0) return Cruise{.duration = still.hold};
  }
  Trial low = trial(lowest);
  Trial high = trial(highest);
  if (low.error > 0.0 || high.error < 0.0) return std::nullopt;
  // The distance rises with the velocity of the cruise. A straight line through both ends of the
  // bracket gives the next trial; the end that is kept then has half its weight (Illinois method).
  double weight_low = low.error;
  double weight_high = high.error;
  for (int i = 0; i < 60 && low.error < 0.0 && high.error > 0.0; ++i) {
    double next =
        (low.velocity * weight_high - high.velocity * weight_low) / (weight_high - weight_low);
    if (!(next > low.velocity && next < high.velocity)) {
      next = (low.velocity + high.velocity) / 2;
    }
    if (!(next > low.velocity && next < high.velocity)) break;
    const Trial middle = trial(next);
    if (middle.error < 0.0) {
      low = middle;
      weight_low = middle.error;
      weight_high /= 2;
    } else {
      high = middle;
      weight_high = middle.error;
      weight_low /= 2;
    }
  }
  const Trial best = -low.error < high.error ? low : high;
  if (best.hold < 0.0) return std::nullopt;
  return Cruise{.velocity = best.velocity, .duration = best.hold};
}

void add_cruise(const Transfer& transfer, const Cruise& cruise, PhaseWriter& writer) noexcept {
  const Change begin = begin_of(transfer, cruise.velocity);
  const Change end = end_of(transfer, cruise.velocity);
  writer.add(begin.phases[0], begin.sign);
  writer.add(begin.phases[1], 0.0);
  writer.add_until(0.0);
  writer.cruise(cruise.duration, std::abs(cruise.velocity));
  writer.add(end.phases[2], -end.sign);
  writer.add(end.phases[1], 0.0);
  writer.add_until(transfer.end_acceleration);
}

}  // namespace takt::motion
