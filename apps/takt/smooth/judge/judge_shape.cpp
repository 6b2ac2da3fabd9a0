#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t fewest_cycles = 20;

double acceleration(const AxisCycles& cycles, std::size_t at) {
  return static_cast<double>(cycles.step(at) - cycles.step(at - 1));
}

/// Returns true if the velocity jumps in this cycle, and is steady before and after it.
bool is_jump(const AxisCycles& cycles, std::size_t at) {
  if (at < 4 || at + 2 >= cycles.cycles.size()) return false;
  for (std::size_t i = at - 2; i <= at + 2; ++i) {
    const Cycle& cycle = cycles.cycles[i];
    if (!cycle.active || !cycle.whole || cycle.count != 1) return false;
  }
  if (cycles.stall(at) != 0) return false;
  const double jump = std::abs(acceleration(cycles, at));
  if (jump < 0.25 * cycles.peak || jump < 8.0 * static_cast<double>(cycles.quantum)) return false;
  for (const std::size_t i : {at - 2, at - 1, at + 1, at + 2}) {
    if (std::abs(acceleration(cycles, i)) > 0.25 * jump) return false;
  }
  return true;
}

void add_jumps(const AxisView& view, Findings& findings) {
  const AxisCycles& cycles = view.cycles;
  std::uint64_t count = 0;
  Time first{};
  double from = 0;
  double to = 0;
  for (std::size_t i = 4; i + 2 < cycles.cycles.size(); ++i) {
    if (!is_jump(cycles, i)) continue;
    if (count++ != 0) continue;
    first = cycles.cycles[i].end;
    from = static_cast<double>(cycles.step(i - 1));
    to = static_cast<double>(cycles.step(i));
  }
  if (count == 0) return;
  findings.push_back(
      {.cause = Cause::velocity_jump,
       .text = fmt::format("The velocity of the set-points jumps {} within one cycle, first at "
                           "{:.3f} s from {:.0f} to {:.0f} increments per second.",
                           times_text(count), seconds(first), cycles.velocity(from),
                           cycles.velocity(to)),
       .remedy = "Let the path begin and end with a ramp, with a limit of the acceleration and "
                 "of the jerk.",
       .count = count,
       .first = first});
}

/// Returns the roughness of the steps in increments, from the median of their fourth differences.
/// The fourth difference is zero for any cubic curve, and single jumps do not change the median.
double roughness(const AxisCycles& cycles) {
  constexpr std::array weights{1, -4, 6, -4, 1};
  const double of_noise = 1.4826 / std::sqrt(70.0);
  std::vector<double> sizes;
  for (std::size_t i = 1; i + weights.size() <= cycles.cycles.size(); ++i) {
    if (!cycles.clean(i, i + weights.size() - 1)) continue;
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      sum += weights[k] * static_cast<double>(cycles.step(i + k));
    }
    sizes.push_back(std::abs(sum));
  }
  return sizes.size() < fewest_cycles ? 0 : median(std::move(sizes)) * of_noise;
}

bool add_coarse(const AxisView& view, Findings& findings) {
  const AxisCycles& cycles = view.cycles;
  const auto quantum = static_cast<double>(cycles.quantum);
  if (cycles.moving < fewest_cycles || cycles.peak == 0 || cycles.peak >= 10 * quantum) {
    return false;
  }
  const bool rounded = cycles.quantum > 1;
  findings.push_back(
      {.cause = Cause::coarse,
       .gravity = Gravity::warning,
       .text = fmt::format(
           "{} In motion, the largest usual step is {:.0f} of them, so the velocity "
           "changes by {:.0f} % from cycle to cycle.",
           rounded ? fmt::format("All set-points are multiples of {} increments.", cycles.quantum)
                   : std::string{"The set-points have coarse increments."},
           cycles.peak / quantum, 100 * quantum / cycles.peak),
       .remedy = rounded ? "The sender rounds its positions: convert them to increments without "
                           "rounding before."
                         : "Choose finer units in the drive (0x608F, 0x6091, 0x6092), or a longer "
                           "period of the set-points, with the same period in 60C2."});
  return true;
}

}  // namespace

void judge_shape(const AxisView& view, Findings& findings) {
  const AxisCycles& cycles = view.cycles;
  add_jumps(view, findings);
  if (add_coarse(view, findings)) return;
  const double rough = roughness(cycles);
  if (rough < 0.02 * cycles.peak || rough < 1.2 * static_cast<double>(cycles.quantum)) return;
  findings.push_back(
      {.cause = Cause::set_point_ripple,
       .text = fmt::format("The set-points are not on a smooth curve: their velocity ripples by "
                           "{:.1f} % (standard deviation {:.0f} increments per second).",
                           100 * rough / cycles.peak, cycles.velocity(rough)),
       .remedy = "Compute each set-point for the time of its SYNC (cycle number x period), not for "
                 "the time at which the program happens to run, and do not copy a measured "
                 "position into the set-point."});
}

}  // namespace takt::smooth
