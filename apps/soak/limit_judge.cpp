#include "apps/soak/limit_judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "apps/soak/image_judge.hpp"
#include "apps/soak/true_axes.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t target_position = 0x607A;
constexpr Time longest_gap = 50ms;  // cycles without a command that may count for one way
constexpr double fewest_cycles = 3;
constexpr double cycles_behind = 4;           // the master's knowledge of the true position
constexpr std::size_t fewest_remembered = 8;  // positions, where none come for a long time

std::int64_t sign_extended(std::uint64_t value, unsigned bits) noexcept {
  const unsigned spare = bits == 0 || bits > 64 ? 0U : 64U - bits;
  return static_cast<std::int64_t>(value << spare) >> spare;
}

unsigned axis_of(const Signal& signal) noexcept {
  return (signal.object.index - target_position) / 0x800U;
}

}  // namespace

LimitJudge::LimitJudge(const BusPlan& plan, sim::World& world, Verdict& verdict)
    : plan_{plan}, world_{world}, verdict_{verdict}, places_(plan.layout.outputs()) {
  for (const OutputLimit& limit : plan.limits.outputs) {
    const Signal& signal = plan.layout.signals[limit.signal];
    if ((signal.object.index & ~0x3800U) != (target_position & ~0x3800U)) continue;
    places_[limit.signal - plan.layout.inputs].limit = &limit;
  }
}

double LimitJudge::allowed(const Place& place, double cycles) const noexcept {
  return std::ceil(std::min(place.limit->step, place.limit->rate) * cycles);
}

bool LimitJudge::near_axis(const Place& place, const Signal& signal, std::int64_t value) {
  const TrueAxis axis = true_axis(world_, signal.node, axis_of(signal));
  const auto way_from = [&](std::int64_t position) {
    return std::abs(static_cast<double>(value - position));
  };
  double way = way_from(axis.position);
  for (const Seen& seen : place.actual) way = std::min(way, way_from(seen.position));
  const double period = std::chrono::duration<double>(plan_.cycle.period).count();
  const double moved = std::abs(static_cast<double>(axis.velocity)) * period * cycles_behind;
  return way <= allowed(place, cycles_behind) + moved;
}

void LimitJudge::begin_cycle(Time now) {
  std::ranges::rotate(cycles_, cycles_.begin() + 1);
  cycles_.back() = now;
  // A babbling node may have sent a hundred of them in a cycle, which all waited while the master
  // was stopped.
  for (Place& place : places_) {
    while (place.actual.size() > fewest_remembered && place.actual.front().when < cycles_.front()) {
      place.actual.pop_front();
    }
  }
}

void LimitJudge::heard(const Frame& frame) {
  for (const PdoRow& row : plan_.pdos.tpdos) {
    if (row.cob_id != frame.id || row.multiplexed()) continue;
    for (std::size_t i = row.first_field; i < row.first_field + row.field_count; ++i) {
      const PdoField& field = plan_.pdos.fields[i];
      for (Place& place : places_) {
        if (place.limit == nullptr || place.limit->feedback != field.signal) continue;
        place.actual.push_back(
            {world_.now(),
             sign_extended(bits_of(frame, field.bit_offset, field.bits), field.bits)});
      }
    }
  }
}

bool LimitJudge::is_actual(SignalIndex signal, std::uint64_t bits) const noexcept {
  const Place& place = places_[signal - plan_.layout.inputs];
  const std::int64_t position = sign_extended(bits, plan_.layout.signals[signal].bits);
  return std::ranges::find(place.actual, position, &Seen::position) != place.actual.end();
}

void LimitJudge::judge_range(const Place& place, const Signal& signal, std::int64_t value,
                             bool near) {
  const auto number = static_cast<double>(value);
  const auto before = static_cast<double>(place.value);
  const double low = std::min(place.limit->low, before);
  const double high = std::max(place.limit->high, before);
  if (near || (number >= low && number <= high)) return;
  blame(signal, value, "is outside the range");
}

void LimitJudge::sent(SignalIndex index, std::uint64_t bits, bool begins, Time now) {
  Place& place = places_[index - plan_.layout.inputs];
  if (place.limit == nullptr) return;
  const Signal& signal = plan_.layout.signals[index];
  const std::int64_t value = sign_extended(bits, signal.bits);
  if (!begins && value == place.value) return;
  const double cycles = std::round(static_cast<double>((now - place.when).count()) /
                                   static_cast<double>(plan_.cycle.period.count()));
  const double most =
      std::max(fewest_cycles, static_cast<double>(longest_gap / plan_.cycle.period));
  const double way = std::abs(static_cast<double>(value - place.value));
  const double reach = allowed(place, std::clamp(cycles, 1.0, most));
  const bool near = near_axis(place, signal, value);
  judge_range(place, signal, value, near);
  place.value = value;
  place.when = now;
  ++judged_;
  if (near || way <= reach) return;
  blame(signal, value,
        "is " + std::to_string(static_cast<long long>(way)) + " counts away from the one before, " +
            std::to_string(static_cast<long long>(reach)) + " are allowed");
}

void LimitJudge::blame(const Signal& signal, std::int64_t value, const std::string& what) {
  verdict_.blame("no output leaves its limits", plan_.nodes[signal.node_index].name + "." +
                                                    signal.name + " = " + std::to_string(value) +
                                                    " " + what);
}

}  // namespace takt
