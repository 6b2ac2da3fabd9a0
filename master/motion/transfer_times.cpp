#include "master/motion/transfer_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace takt::motion {
namespace {

/// Returns the range of durations that are impossible because the velocity can't rise as much as
/// the transfer needs. Both ends of the range are possible. The range is empty if `last` is less
/// than `first`.
///
/// The motion with the highest end velocity has jerk 1, then perhaps the greatest acceleration,
/// then jerk -1. This velocity is a convex function of the duration. If the acceleration has a peak
/// p below its limit, the velocity rises by p^2 - (a0^2 + a1^2) / 2, where a0 and a1 are the
/// accelerations at both ends. For longer durations the function is a straight line.
TimeRange too_slow(const Transfer& t) noexcept {
  const double sum = t.start_acceleration + t.end_acceleration;
  const double squares =
      t.start_acceleration * t.start_acceleration + t.end_acceleration * t.end_acceleration;
  const double square = t.end_velocity - t.start_velocity + squares / 2;
  if (square < 0.0) return {0.0, -1.0};
  const double peak = std::sqrt(square);
  const double held = std::min(peak, t.max_acceleration);
  const double hold = (square - held * held) / held;
  return {-2 * peak - sum, 2 * held - sum + (peak > held ? hold : 0.0)};
}

}  // namespace

TransferTimes::TransferTimes(const Transfer& transfer) noexcept {
  std::array blocked{too_slow(transfer), too_slow(mirrored(transfer))};
  if (blocked[1].first < blocked[0].first) std::swap(blocked[0], blocked[1]);
  double first = std::abs(transfer.end_acceleration - transfer.start_acceleration);
  for (const TimeRange& block : blocked) {
    if (block.last <= first) continue;
    if (block.first >= first) add(first, block.first);
    first = block.last;
  }
  add(first, std::numeric_limits<double>::infinity());
}

}  // namespace takt::motion
