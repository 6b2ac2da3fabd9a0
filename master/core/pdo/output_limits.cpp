#include "master/core/pdo/output_limits.hpp"

#include <chrono>
#include <cmath>

#include "eds_parser/table/output_limits.hpp"

namespace takt {
namespace {

constexpr Time longest_gap = std::chrono::milliseconds{50};
constexpr double fewest_cycles = 3;       // least number of cycles for longest_gap
constexpr double from_actual_cycles = 1;  // cycles of a step that begins at the actual position
constexpr double rounding = 1e-6;         // rounding errors of the arithmetic, in counts

LimitBreach breach(LimitKind kind, double measured, double limit) noexcept {
  return {kind, static_cast<float>(measured), static_cast<float>(limit)};
}

}  // namespace

OutputLimits::OutputLimits(const BusPlan& plan, const WorkingImage& image, const PdoInputs& inputs)
    : plan_{plan},
      image_{image},
      inputs_{inputs},
      limits_{plan.limits.outputs},
      places_(plan.layout.signals.size(), no_place),
      dependents_(plan.layout.signals.size()),
      judged_(plan.layout.signals.size()),
      concerned_(plan.layout.signals.size()),
      slots_(limits_.size()),
      longest_gap_{fewest_cycles},
      seconds_{std::chrono::duration<double>(plan.cycle.period).count()} {
  notations_.reserve(plan.layout.signals.size());
  for (const Signal& signal : plan.layout.signals) notations_.emplace_back(signal);
  if (plan.cycle.period > Time{0}) {
    longest_gap_ = std::max(fewest_cycles, static_cast<double>(longest_gap / plan.cycle.period));
  }
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const auto place = static_cast<std::uint16_t>(i);
    places_[limits_[i].signal] = place;
    judged_[limits_[i].signal] = 1;
    if (limits_[i].offset) judged_[*limits_[i].offset] = 1;
    if (limits_[i].mode) judged_[*limits_[i].mode] = 1;
    if (limits_[i].modulus <= 0) {
      limits_[i].modulus = limits_[i].wraps ? std::ldexp(1.0, signal_of(i).bits) : 0.0;
    }
    for (const auto& signal : {limits_[i].controlword, limits_[i].offset, limits_[i].mode}) {
      if (signal) dependents_[*signal].push_back(place);
    }
    slots_[i] = fresh_slot(i);
  }
  find_concerned();
}

void OutputLimits::open(std::size_t node_index) noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (signal_of(i).node_index == node_index) slots_[i] = fresh_slot(i);
  }
  find_concerned();
}

/// Returns true if a command to this output can be refused: it has a limit, or it may be no number
/// at all (a NaN of REAL32 or REAL64).
bool OutputLimits::checked(std::size_t place) const noexcept {
  const auto& offset = limits_[place].offset;
  return slots_[place].bounded || is_real(signal_of(place).type) ||
         (offset && is_real(plan_.layout.signals[*offset].type));
}

/// Determines again on which outputs a limit depends. The result changes only when a node begins to
/// exchange PDOs and when its limits are read.
void OutputLimits::find_concerned() noexcept {
  std::ranges::fill(concerned_, std::uint8_t{0});
  concerns_any_ = false;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!checked(i)) continue;
    concerns_any_ = true;
    const OutputLimit& limit = limits_[i];
    concerned_[limit.signal] = 1;
    for (const auto& signal : {limit.controlword, limit.offset, limit.mode, limit.target}) {
      if (signal) concerned_[*signal] = 1;
    }
  }
}

OutputLimits::Slot OutputLimits::fresh_slot(std::size_t place) const noexcept {
  const OutputLimit& limit = limits_[place];
  Slot slot;
  slot.low = limit.low;
  slot.high = limit.high;
  slot.rate = limit.rate;
  slot.bend = limit.bend;
  slot.bounded = limit.low != -OutputLimit::none || limit.high != OutputLimit::none ||
                 limit.step != OutputLimit::none || limit.rate != OutputLimit::none ||
                 limit.bend != OutputLimit::none;
  return slot;
}

bool OutputLimits::narrow(const DeviceLimit& what, std::uint32_t low, std::uint32_t high) noexcept {
  const auto first = static_cast<std::int32_t>(low);
  const auto last = static_cast<std::int32_t>(high);
  const bool is_range = what.bound == DeviceBound::range;
  if (is_range ? !plausible_range(first, last) : !plausible_size(high)) return false;
  Slot& slot = slots_[places_[what.signal]];
  slot.bounded = true;
  find_concerned();
  const double size = high * what.factor;
  switch (what.bound) {
    case DeviceBound::range:
      slot.low = std::max(slot.low, first * what.factor);
      slot.high = std::min(slot.high, last * what.factor);
      return true;
    case DeviceBound::size:
      slot.low = std::max(slot.low, -size);
      slot.high = std::min(slot.high, size);
      return true;
    case DeviceBound::rate:
      slot.rate = std::min(slot.rate, size);
      return true;
    case DeviceBound::bend:
      slot.bend = std::min(slot.bend, size);
      return true;
  }
  return false;
}

/// Returns the distance between two positions. If positions wrap, it is the shorter way around,
/// provided that they are less than one turn apart. A difference of a turn or more is a real
/// distance that the axis would move.
double OutputLimits::distance(std::size_t place, double from, double to) const noexcept {
  const double modulus = limits_[place].modulus;
  const double way = to - from;
  const double length = std::abs(way);
  if (length <= modulus / 2 || length >= modulus) return way;
  return way - std::copysign(modulus, way);
}

std::optional<double> OutputLimits::actual(std::size_t place) const noexcept {
  const auto feedback = limits_[place].feedback;
  if (!feedback || !inputs_.fresh(*feedback)) return std::nullopt;
  return number(*feedback, image_.values[*feedback]);
}

/// Returns the value of the offset in counts of the limited output.
double OutputLimits::offset(std::size_t place, std::int64_t raw) const noexcept {
  const auto added = limits_[place].offset;
  if (!added) return 0;
  const double scale = plan_.layout.signals[*added].scale;
  return number(*added, raw) * (scale / signal_of(place).scale);
}

/// Returns the set-point that the axis would follow, in counts of the limited output.
double OutputLimits::set_point(std::size_t place, const AxisCommand& command,
                               ModesFollowed modes) const noexcept {
  const double target = number(limits_[place].signal, command.value);
  return modes.any() ? target + offset(place, command.offset) : target;
}

/// Returns the set-point that results from the values that were sent last if the axis is in the
/// commanded mode.
double OutputLimits::last_set_point(std::size_t place, ModesFollowed modes) const noexcept {
  const Slot& slot = slots_[place];
  return modes.any() ? slot.value + slot.offset : slot.value;
}

AxisCommand OutputLimits::image_command(std::size_t place) const noexcept {
  const auto value = [&](std::optional<SignalIndex> signal) {
    return signal ? image_.values[*signal] : 0;
  };
  return {.value = image_.values[limits_[place].signal],
          .offset = value(limits_[place].offset),
          .mode = value(limits_[place].mode),
          .order = value(limits_[place].controlword)};
}

double OutputLimits::cycles_since(const Slot& slot, std::uint64_t cycle) const noexcept {
  if (cycle <= slot.cycle) return 1;
  return std::min(static_cast<double>(cycle - slot.cycle), longest_gap_);
}

double OutputLimits::most(std::size_t place, double counts, double at) const noexcept {
  const DataType type = signal_of(place).type;
  if (type == DataType::real32) return counts + std::abs(at) * 0x1p-22;
  if (type == DataType::real64) return counts + std::abs(at) * 0x1p-50;
  return std::ceil(counts - rounding);
}

bool OutputLimits::exceeds(std::size_t place, double length, double counts,
                           double at) const noexcept {
  if (length <= counts - rounding) [[likely]] {
    return false;  // This check needs no rounding, which would take longer.
  }
  return !(length <= most(place, counts, at));
}

std::optional<LimitBreach> OutputLimits::outside(std::size_t place, double value,
                                                 bool from_actual) const noexcept {
  const OutputLimit& limit = limits_[place];
  const Slot& slot = slots_[place];
  if (value >= slot.low && value <= slot.high) return std::nullopt;
  double low = slot.low;
  double high = slot.high;
  const auto reach = [&](double where) {
    low = std::min(low, where);
    high = std::max(high, where);
  };
  if (slot.set_point) reach(*slot.set_point);
  if (from_actual) {
    if (const auto where = actual(place)) reach(*where);
  }
  if (value >= low && value <= high) return std::nullopt;
  const Signal& signal = signal_of(place);
  const double bound = value < low ? slot.low : slot.high;
  // A velocity or a torque is limited as a magnitude, to which no offset of the unit applies.
  const bool absolute = limit.range == LimitKind::position || limit.range == LimitKind::range;
  const double zero = absolute ? signal.offset : 0;
  return breach(limit.range, value * signal.scale + zero, bound * signal.scale + zero);
}

std::optional<LimitBreach> OutputLimits::too_far(std::size_t place, const Way& way) const noexcept {
  const OutputLimit& limit = limits_[place];
  const Slot& slot = slots_[place];
  const double scale = std::abs(signal_of(place).scale);
  const double length = std::abs(way.distance);
  if (exceeds(place, length, limit.step * way.cycles, way.at)) {
    return breach(LimitKind::step, length / way.cycles * scale, limit.step * scale);
  }
  if (exceeds(place, length, slot.rate * way.cycles, way.at)) {
    const double per_second = scale / seconds_;
    return breach(limit.rate_of, length / way.cycles * per_second, slot.rate * per_second);
  }
  const bool bent_only = limit.step == OutputLimit::none && slot.rate == OutputLimit::none;
  const double reach = slot.bend * longest_gap_ * longest_gap_;
  if (way.start == Start::standing && bent_only && exceeds(place, length, reach, way.at)) {
    const double per_square = scale / (seconds_ * seconds_ * longest_gap_ * longest_gap_);
    return breach(LimitKind::acceleration, length * per_square,
                  slot.bend * scale / (seconds_ * seconds_));
  }
  return std::nullopt;
}

/// Checks the acceleration, which is the second difference of the last three values. Each of them
/// is rounded to a count, so a difference up to `feigned` may only be an effect of rounding.
std::optional<LimitBreach> OutputLimits::too_sharp(std::size_t place,
                                                   const Way& way) const noexcept {
  const Slot& slot = slots_[place];
  const double bend = slot.bend;
  if (bend == OutputLimit::none) return std::nullopt;
  const double before = way.cycles < longest_gap_ ? slot.speed : 0.0;
  const double apart = (way.cycles + slot.gap) / 2;
  const double feigned = is_real(signal_of(place).type) ? most(place, 0, 2 * way.at) * 2
                                                        : 1 / way.cycles + 1 / slot.gap;
  const double found = std::abs(way.distance / way.cycles - before);
  if (found <= bend * apart + feigned + rounding) return std::nullopt;
  const double scale = std::abs(signal_of(place).scale) / (seconds_ * seconds_);
  return breach(LimitKind::acceleration, found / apart * scale, bend * scale);
}

bool OutputLimits::lacks_start(std::size_t place, std::int64_t mode) const noexcept {
  const Slot& slot = slots_[place];
  if (slot.known || limits_[place].quantity == AxisQuantity::velocity) return false;
  const bool measured = limits_[place].step != OutputLimit::none ||
                        slot.rate != OutputLimit::none || slot.bend != OutputLimit::none;
  return measured && limits_[place].feedback && !inputs_.fresh(*limits_[place].feedback) &&
         follows_each(place, modes_followed(place, mode));
}

/// Returns the distance of `value` from the actual position. With `from_earlier`, the nearest
/// actual position of the last cycles counts. The function may be called only if there is an actual
/// position.
double OutputLimits::distance_from_actual(std::size_t place, double value,
                                          bool from_earlier) const noexcept {
  const Slot& slot = slots_[place];
  double found = distance(place, actual(place).value_or(value), value);
  for (std::size_t i = 0; from_earlier && i < slot.remembered; ++i) {
    const double other = distance(place, slot.positions[i], value);
    if (std::abs(other) < std::abs(found)) found = other;
  }
  return found;
}

std::optional<LimitBreach> OutputLimits::judge(std::size_t place, const AxisCommand& command,
                                               Obeying obeying,
                                               std::uint64_t cycle) const noexcept {
  if (limits_[place].orders) return judge_speed(place, command, obeying, cycle);
  const Slot& slot = slots_[place];
  const ModesFollowed mode = modes_followed(place, command.mode);
  const double value = set_point(place, command, mode);
  const bool each = follows_each(place, mode);
  const bool follows = obeying == Obeying::yes && enabled(place);
  const bool rests = starts_from_actual(place, command.order);
  const bool from_last = !rests && starts_from_last(place, mode);
  const bool from_actual = !follows || !from_last;
  if (const auto found = outside(place, value, from_actual)) return found;
  if (!each) return std::nullopt;
  std::optional<LimitBreach> found;
  if (from_last) {
    if (command.age == SetPointAge::held) return std::nullopt;
    const Way way{.distance = distance(place, last_set_point(place, mode), value),
                  .cycles = follows ? cycles_since(slot, cycle) : 1.0,
                  .at = value,
                  .start = follows ? Start::moving : Start::standing};
    found = too_far(place, way);
    if (!found && follows) found = too_sharp(place, way);
    if (!found) return std::nullopt;
  }
  if (!from_actual || !mode.any() || !actual(place)) return found;
  const bool computed = command.age == SetPointAge::commanded;
  const bool lags = rests && computed && !enables(command.order);
  // An actual velocity is measured with noise that may be larger than the step of a cycle.
  const bool noisy = limits_[place].quantity == AxisQuantity::velocity;
  return too_far(place, {.distance = distance_from_actual(place, value, lags),
                         .cycles = noisy ? longest_gap_ : from_actual_cycles,
                         .at = value,
                         .start = Start::standing});
}

void OutputLimits::remember() noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!limits_[i].feedback || !concerns(limits_[i].signal)) continue;
    Slot& slot = slots_[i];
    const auto where = actual(i);
    if (!where) {
      slot.remembered = 0;
      continue;
    }
    std::ranges::copy_backward(slot.positions.begin(), slot.positions.end() - 1,
                               slot.positions.end());
    slot.positions[0] = *where;
    if (slot.remembered < cycles_remembered) ++slot.remembered;
  }
}

void OutputLimits::admit(std::size_t place, const AxisCommand& command,
                         std::uint64_t cycle) noexcept {
  Slot& slot = slots_[place];
  slot.unsent = true;
  // An event-driven frame is not sent again for the same value, so the command counts as sent.
  if (!slot.known || limits_[place].orders) return;
  const ModesFollowed mode = modes_followed(place, command.mode);
  if (set_point(place, command, mode) != last_set_point(place, mode)) return;
  slot.cycle = cycle;
  slot.speed = 0;
  slot.gap = 1;
}

void OutputLimits::pass_over(std::size_t place, std::uint64_t cycles,
                             std::uint64_t cycle) noexcept {
  Slot& slot = slots_[place];
  if (slot.cycle + cycles < cycle) slot.cycle += cycles;
}

void OutputLimits::sent(SignalIndex signal, std::uint64_t cycle) noexcept {
  for (const std::uint16_t place : dependents_[signal]) {
    if (limits_[place].controlword == signal) slots_[place].order = image_.values[signal];
    const bool counts = limits_[place].offset == signal || limits_[place].orders;
    if (counts && slots_[place].known) note_sent(place, cycle);
  }
  if (places_[signal] == no_place) return;
  note_sent(places_[signal], cycle);
  slots_[places_[signal]].known = true;
}

void OutputLimits::note_sent(std::size_t place, std::uint64_t cycle) noexcept {
  if (limits_[place].orders) return note_speed_sent(place, cycle);
  Slot& slot = slots_[place];
  const AxisCommand command = image_command(place);
  const ModesFollowed mode = modes_followed(place, command.mode);
  const double value = set_point(place, command, mode);
  const double last = last_set_point(place, mode);
  if (!slot.known || slot.unsent || value != last) {
    const double cycles = cycles_since(slot, cycle);
    const bool moves = slot.known && slot.unsent && enabled(place);
    slot.speed = moves ? distance(place, last, value) / cycles : 0.0;
    slot.gap = moves ? cycles : 1.0;
    slot.cycle = cycle;
  }
  slot.value = number(limits_[place].signal, command.value);
  slot.offset = offset(place, command.offset);
  slot.set_point = value;
  if (limits_[place].target && mode.both()) slot.set_point.reset();
  slot.unsent = false;
  slot.idle = !follows_each(place, mode);
}

}  // namespace takt
