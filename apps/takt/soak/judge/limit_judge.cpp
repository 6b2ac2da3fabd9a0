#include "apps/takt/soak/judge/limit_judge.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

#include "apps/takt/soak/evidence/image_judge.hpp"
#include "apps/takt/soak/evidence/true_axes.hpp"
#include "eds_parser/table/axis_modes.hpp"
#include "eds_parser/table/output_limits.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t axis_objects = 0x800;  // distance of two axes in a device, CiA 402
constexpr std::uint16_t first_axis_objects = 0x6000;
constexpr double cycles_behind = 4;  // age of the actual position that the master knows
// Number of positions that are kept even if they are old.
constexpr std::size_t fewest_remembered = 8;
constexpr double real_rounding = 0x1p-20;  // relative rounding of a value of type REAL

double number(const Signal& signal, std::uint64_t bits) noexcept {
  if (signal.type == DataType::real32) {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  }
  if (signal.type == DataType::real64) return std::bit_cast<double>(bits);
  const unsigned spare = signal.bits == 0 || signal.bits > 64 ? 0U : 64U - signal.bits;
  const std::uint64_t top = bits << spare;
  if (!is_signed(signal.type)) return static_cast<double>(top >> spare);
  return static_cast<double>(static_cast<std::int64_t>(top) >> spare);
}

/// Returns true for the fallback value and the safe value. The master sends them without a command,
/// and no limit of step, velocity or acceleration applies to them.
bool is_own_value(const Signal& signal, double value) noexcept {
  const auto is = [&](std::int64_t own) {
    return value == number(signal, static_cast<std::uint64_t>(own));
  };
  return (signal.fallback == Fallback::value && is(signal.fallback_value)) ||
         (signal.safe_value && is(*signal.safe_value));
}

}  // namespace

LimitJudge::LimitJudge(const BusPlan& plan, sim::World& world, Verdict& verdict)
    : plan_{plan},
      world_{world},
      verdict_{verdict},
      most_cycles_{most_cycles_of_way(plan.cycle.period)},
      places_(plan.layout.outputs()),
      sent_(plan.layout.outputs()) {
  for (const OutputLimit& limit : plan.limits.outputs) {
    Place& place = places_[limit.signal - plan.layout.inputs];
    if (place.limit == nullptr) limited_.push_back(&place);
    place.limit = &limit;
    const Signal& target = signal_of(place);
    for (std::size_t i = plan.layout.inputs; i < plan.layout.signals.size(); ++i) {
      const Signal& other = plan.layout.signals[i];
      const bool same_axis =
          other.node_index == target.node_index &&
          other.object.index / axis_objects == target.object.index / axis_objects;
      if (same_axis && other.object.index % axis_objects == 0x40) {
        place.controlword = static_cast<SignalIndex>(i);
      }
    }
  }
}

void LimitJudge::begin_anew() {
  for (Place& place : places_) {
    place.value.reset();
    place.last_way.reset();
    place.change = Change::none;
    place.enables = false;
    place.doubt = state_doubt;
  }
}

void LimitJudge::begin_cycle(Time now) {
  std::ranges::rotate(cycles_, cycles_.begin() + 1);
  cycles_.back() = now;
  for (Place* const place : limited_) {
    if (place->doubt != 0) --place->doubt;
    if (place->mode_doubt != 0) --place->mode_doubt;
    // All positions of the newest cycles are kept. A babbling node may send a hundred positions in
    // a cycle, and they may have waited in the queue while the master was stopped.
    while (place->actual.size() > fewest_remembered &&
           place->actual.front().when < cycles_.front()) {
      place->actual.pop_front();
    }
  }
}

void LimitJudge::heard(const Frame& frame) {
  for (const PdoRow& row : plan_.pdos.tpdos) {
    if (row.cob_id != frame.id || row.multiplexed() || frame.length < row.length) continue;
    for (const PdoField& field : plan_.pdos.fields_of(row)) {
      note_input(field.signal, bits_of(frame, field.bit_offset, field.bits));
    }
  }
}

void LimitJudge::note_input(SignalIndex signal, std::uint64_t bits) {
  const double value = number(plan_.layout.signals[signal], bits);
  for (Place* const place : limited_) {
    const OutputLimit& limit = *place->limit;
    if (limit.feedback == signal) place->actual.push_back({world_.now(), value});
    if (limit.mode_display == signal && !limit.mode) note_mode(*place, bits);
    if (limit.statusword != signal) continue;
    place->enabled = (bits & 0x6F) == 0x27;
    if (!place->enabled) place->doubt = state_doubt;
  }
}

/// Notes controlwords and modes, which determine the meaning of the targets of their axis.
void LimitJudge::note_order(SignalIndex signal, std::uint64_t bits) {
  for (Place* const place : limited_) {
    if (place->limit->mode == signal) note_mode(*place, bits);
    if (place->controlword != signal) continue;
    place->enables = (bits & 0x0F) == 0x0F;
    if (!place->enables) place->doubt = state_doubt;
  }
}

bool LimitJudge::is_actual(SignalIndex signal, std::uint64_t bits) const noexcept {
  const Place& place = places_[signal - plan_.layout.inputs];
  const double position = number(plan_.layout.signals[signal], bits);
  return std::ranges::find(place.actual, position, &Seen::position) != place.actual.end();
}

/// Returns true if the drive certainly follows set-points and the master certainly knows that.
bool LimitJudge::follows(const Place& place) const noexcept {
  return place.doubt == 0 && place.enabled && (place.enables || !place.controlword);
}

void LimitJudge::note_mode(Place& place, std::uint64_t bits) noexcept {
  const auto mode = static_cast<std::int8_t>(bits);
  if (mode != place.mode) place.mode_doubt = state_doubt;
  place.mode = mode;
}

std::optional<std::int64_t> LimitJudge::mode_of(const Place& place) const noexcept {
  const bool known = place.limit->mode || place.limit->mode_display;
  return known ? std::optional{place.mode} : place.limit->fixed_mode;
}

/// Returns true if the axis follows this set-point. `mode_doubt` shows whether this is certain.
bool LimitJudge::in_force(const Place& place) const noexcept {
  const auto mode = mode_of(place);
  return !mode || takt::follows(place.limit->quantity, *mode);
}

/// Returns true if only the range is checked, because the axis does not follow positions, or
/// because the drive has ramps of its own.
bool LimitJudge::in_profile(const Place& place) const noexcept {
  return ramps(place) || (place.limit->quantity == AxisQuantity::position && !in_force(place));
}

bool LimitJudge::ramps(const Place& place) const noexcept {
  const auto mode = mode_of(place);
  return mode && has_ramps(place.limit->quantity, *mode);
}

/// Returns the distance between two positions, for a rotary axis the shorter one. A distance of a
/// whole turn or more counts in full.
double LimitJudge::length(const Place& place, double from, double to) const noexcept {
  const double wrap = place.limit->wraps ? std::ldexp(1.0, signal_of(place).bits) : 0.0;
  const double turn = place.limit->modulus > 0 ? place.limit->modulus : wrap;
  const double way = to - from;
  if (std::abs(way) >= turn || 2 * std::abs(way) <= turn) return way;
  return way > 0 ? way - turn : way + turn;
}

Way LimitJudge::way_to(const Place& place, double value, Time now) const noexcept {
  return {.length = length(place, *place.value, value),
          .cycles = cycles_between(place.when, now, plan_.cycle.period, most_cycles_)};
}

/// Returns the largest distance between a set-point and the actual value of an axis after this
/// number of cycles, in counts.
double LimitJudge::reach(const Place& place, double cycles) const noexcept {
  const double rate = std::min(place.limit->step, place.limit->rate);
  if (rate != OutputLimit::none) return std::ceil(rate * cycles);
  return std::ceil(place.limit->bend * most_cycles_ * most_cycles_);
}

bool LimitJudge::near_axis(const Place& place, double value) {
  const Signal& feedback = plan_.layout.signals[*place.limit->feedback];
  const TrueAxis axis =
      true_axis(world_, feedback.node,
                static_cast<unsigned>(feedback.object.index - first_axis_objects) / axis_objects);
  const bool turns = place.limit->quantity == AxisQuantity::velocity;
  const auto truth = static_cast<double>(turns ? axis.velocity : axis.position);
  double way = std::abs(length(place, truth, value));
  for (const Seen& seen : place.actual) {
    way = std::min(way, std::abs(length(place, seen.position, value)));
  }
  if (turns) return way <= reach(place, most_cycles_);
  const double period = std::chrono::duration<double>(plan_.cycle.period).count();
  const double moved = std::abs(static_cast<double>(axis.velocity)) * period * cycles_behind;
  return way <= reach(place, cycles_behind) + moved;
}

/// Checks the range. An output outside its range may move back, but not further away.
void LimitJudge::judge_range(const Place& place, double value) {
  double low = std::min(place.limit->low, place.value.value_or(OutputLimit::none));
  double high = std::max(place.limit->high, place.value.value_or(-OutputLimit::none));
  if (!follows(place)) {
    for (const Seen& seen : place.actual) {
      low = std::min(low, seen.position);
      high = std::max(high, seen.position);
    }
  }
  if (value >= low && value <= high) return;
  report_violation(place, value, place.limit->range, "the value is outside the range");
}

void LimitJudge::judge_way(const Place& place, double value, const Way& way) {
  const double counts = std::abs(way.length);
  const auto judge = [&](double rate, LimitKind kind) {
    const double rounding = is_real(signal_of(place).type) ? real_rounding * std::abs(value) : 0.0;
    const double most = std::ceil(rate * way.cycles) + rounding;
    if (counts <= most || !std::isfinite(rate)) return;
    report_violation(
        place, value, kind,
        fmt::format(
            "the value is {:.0f} counts away from the previous value; {:.0f} counts are allowed",
            counts, most));
  };
  judge(place.limit->step, LimitKind::step);
  judge(place.limit->rate, place.limit->rate_of);
}

void LimitJudge::judge_bend(const Place& place, double value, const Way& way) {
  const bool real = is_real(signal_of(place).type);
  if (place.limit->bend == OutputLimit::none || !place.last_way || real) return;
  if (!is_too_sharp(place.limit->bend, way, *place.last_way)) return;
  report_violation(
      place, value, LimitKind::acceleration,
      fmt::format(
          "the value changes by {:.0f} counts in {} cycles, after {:.0f} counts in {} cycles",
          way.length, way.cycles, place.last_way->length, place.last_way->cycles));
}

void LimitJudge::sent(SignalIndex index, std::uint64_t bits, bool begins) {
  note_order(index, bits);
  sent_[index - plan_.layout.inputs] = number(plan_.layout.signals[index], bits);
  for (Place* const place : limited_) {
    if (place->limit->signal == index) {
      if (begins) {
        place->enables = false;
        place->doubt = state_doubt;
      }
      place->change = std::max(place->change, begins ? Change::begins : Change::value);
    } else if (place->limit->offset == index && place->change == Change::none && place->value) {
      place->change = Change::value;
    }
  }
}

void LimitJudge::judge(Time now) {
  for (Place* const place : limited_) {
    const Change change = std::exchange(place->change, Change::none);
    if (change != Change::none) judge_place(*place, change, now);
  }
}

/// Returns the value to which the limits of an output apply: the sum with its offset if the drive
/// adds both. The result is empty if the output is an offset that the drive adds to a target,
/// because the limits then apply to the sum. It is also empty if the mode has changed so recently
/// that it is uncertain whether the drive adds both.
std::optional<double> LimitJudge::limited_value(const Place& place) const noexcept {
  const OutputLimit& limit = *place.limit;
  const double value = sent_[limit.signal - plan_.layout.inputs];
  if (!limit.offset && !limit.target) return value;
  if (place.mode_doubt != 0) return std::nullopt;
  if (!in_force(place)) return value;
  if (limit.target) return std::nullopt;
  const Signal& offset = plan_.layout.signals[*limit.offset];
  const double added = sent_[*limit.offset - plan_.layout.inputs];
  return value + added * (offset.scale / signal_of(place).scale);
}

/// Returns true if the master may have sent the value without a command. For a sum, this must be
/// true for each part that is new.
bool LimitJudge::is_own(const Place& place) const noexcept {
  const auto own = [&](SignalIndex signal) {
    return is_own_value(plan_.layout.signals[signal], sent_[signal - plan_.layout.inputs]);
  };
  const auto& offset = place.limit->offset;
  if (!offset) return own(place.limit->signal);
  const double target_now = sent_[place.limit->signal - plan_.layout.inputs];
  const double offset_now = sent_[*offset - plan_.layout.inputs];
  return (target_now == place.target || own(place.limit->signal)) &&
         (offset_now == place.offset || own(*offset));
}

void LimitJudge::judge_place(Place& place, Change change, Time now) {
  const auto limited = limited_value(place);
  if (!limited) {
    place.value.reset();
    place.last_way.reset();
    return;
  }
  const double value = *limited;
  if (change == Change::value && value == place.value) return;
  ++judged_;
  const bool own = is_own(place);
  if (own) place.doubt = state_doubt;
  if (!own) judge_range(place, value);
  const bool from_actual = !follows(place) || place.ramped;
  const bool free =
      own || in_profile(place) || (from_actual && place.limit->feedback && near_axis(place, value));
  std::optional<Way> way;
  if (place.value && !place.ramped) way = way_to(place, value, now);
  if (way && !free) judge_way(place, value, *way);
  if (way && !free && follows(place)) judge_bend(place, value, *way);
  const bool begins = !place.value || place.ramped;
  if (begins && !free && place.limit->feedback && in_force(place)) {
    report_violation(place, value, LimitKind::step, "the first value is far from the actual value");
  }
  place.last_way = follows(place) && !in_profile(place) ? way : std::nullopt;
  place.value = value;
  place.ramped = ramps(place);
  place.target = sent_[place.limit->signal - plan_.layout.inputs];
  if (place.limit->offset) place.offset = sent_[*place.limit->offset - plan_.layout.inputs];
  place.when = now;
}

void LimitJudge::report_violation(const Place& place, double value, LimitKind kind,
                                  const std::string& what) {
  const Signal& signal = signal_of(place);
  verdict_.report_violation(
      "no output leaves its limits",
      fmt::format("{}.{} = {:.0f} breaks the limit of {}: {}", plan_.nodes[signal.node_index].name,
                  signal.name, value, name(kind), what));
}

}  // namespace takt::soak
