#include <algorithm>
#include <cmath>

#include "master/core/pdo/output_limits.hpp"

// The checks of the set speed of an inverter. The speed that the drive follows is the set speed
// times the factor of the control word: 1, -1 for backward, or 0 while the drive is commanded to
// stop.

namespace takt {
namespace {

constexpr double smallest_change = 1e-6;  // in counts

}  // namespace

std::optional<LimitBreach> OutputLimits::judge_speed(std::size_t place, const AxisCommand& command,
                                                     Obeying obeying,
                                                     std::uint64_t cycle) const noexcept {
  const OutputLimit& limit = limits_[place];
  const Slot& slot = slots_[place];
  const double factor = limit.orders->factor(command.order);
  if (factor == 0.0) return std::nullopt;
  const double scale = std::abs(limit.orders->scale);
  const double speed = factor * number(limit.signal, command.value);
  const auto breach = [&](LimitKind kind, double measured, double bound) {
    return LimitBreach{kind, static_cast<float>(measured), static_cast<float>(bound)};
  };
  if (!(speed >= slot.low && speed <= slot.high)) {
    return breach(limit.range, speed * scale, (speed < slot.low ? slot.low : slot.high) * scale);
  }
  const bool follows = obeying == Obeying::yes && slot.known;
  const double change = std::abs(speed - (follows ? slot.set_point.value_or(0.0) : 0.0));
  const double most = follows ? allowance(place, cycle) : slot.rate * longest_gap_;
  if (!exceeds(place, change, most, speed)) return std::nullopt;
  const double bound = slot.rate * scale / seconds_;
  return breach(limit.rate_of, bound * change / std::max(most, smallest_change), bound);
}

/// Returns by how much the speed may change now. Changes that were permitted in the last 50 ms and
/// were not used are still permitted. Therefore a program may send late, or send two commands in
/// one cycle, if it keeps the acceleration on average.
double OutputLimits::allowance(std::size_t place, std::uint64_t cycle) const noexcept {
  const Slot& slot = slots_[place];
  if (slot.rate == OutputLimit::none) return OutputLimit::none;
  const auto cycles = static_cast<double>(cycle > slot.cycle ? cycle - slot.cycle : 0);
  return std::min(slot.rate * longest_gap_, slot.allowed + slot.rate * cycles);
}

void OutputLimits::note_speed_sent(std::size_t place, std::uint64_t cycle) noexcept {
  Slot& slot = slots_[place];
  const AxisCommand command = image_command(place);
  const double factor = limits_[place].orders->factor(command.order);
  const double before = slot.set_point.value_or(0.0);
  slot.value = number(limits_[place].signal, command.value);
  slot.set_point = factor * slot.value;
  // A drive that stops does so along its own ramp.
  const double used = factor == 0.0 ? 0.0 : std::abs(*slot.set_point - before);
  const double left = slot.known ? allowance(place, cycle) : slot.rate * longest_gap_;
  slot.allowed = left == OutputLimit::none ? 0.0 : std::max(0.0, left - used);
  slot.cycle = cycle;
  slot.unsent = false;
}

}  // namespace takt
