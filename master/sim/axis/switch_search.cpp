#include "master/sim/axis/switch_search.hpp"

#include <array>
#include <cmath>

namespace takt::sim {
namespace {

using enum TravelSwitch;

/// Methods 1 to 14.
constexpr std::array<HomingMethod, 14> with_index{{
    {.seeks = negative_limit, .first = -1, .last = 1},
    {.seeks = positive_limit, .first = 1, .last = -1},
    {.first = 1, .last = -1},
    {.first = 1, .last = 1, .enters = true},
    {.first = -1, .last = 1},
    {.first = -1, .last = -1, .enters = true},
    {.first = 1, .last = -1},
    {.first = 1, .last = 1, .enters = true},
    {.first = 1, .last = -1, .enters = true},
    {.first = 1, .last = 1},
    {.first = -1, .last = 1},
    {.first = -1, .last = -1, .enters = true},
    {.first = -1, .last = 1, .enters = true},
    {.first = -1, .last = -1},
}};

}  // namespace

std::optional<HomingMethod> homing_method(std::int64_t number) noexcept {
  if (number == 33 || number == 34) {
    const double direction = number == 33 ? -1 : 1;
    return HomingMethod{
        .needs_switch = false, .first = direction, .last = direction, .with_index = true};
  }
  const bool indexed = number >= 1 && number <= 14;
  if (!indexed && (number < 17 || number > 30)) return std::nullopt;
  HomingMethod method = with_index[static_cast<std::size_t>((number - 1) % 16)];
  method.with_index = indexed;
  return method;
}

void SwitchSearch::begin(const HomingMethod& method, const TravelSensors& sensors) noexcept {
  method_ = method;
  turned_ = false;
  direction_ = method.first;
  step_ = Step::seek;
  if (!method.needs_switch) step_ = Step::index;
  if (method.needs_switch && sensors.active(method.seeks)) step_ = Step::settle;
}

/// Returns true if the axis moves into a limit switch that ends its way.
bool SwitchSearch::blocked(const TravelSensors& sensors) const noexcept {
  const TravelSwitch limit = direction_ > 0 ? positive_limit : negative_limit;
  return sensors.active(limit) && !(method_.needs_switch && method_.seeks == limit);
}

SwitchSearch::Result SwitchSearch::step(const TravelSensors& sensors, Demand& demand,
                                        const SearchSpeeds& speeds, const Ramps& ramps,
                                        double h) noexcept {
  Result result = Result::running;
  double speed = speeds.slow;
  switch (step_) {
    case Step::seek:
      speed = speeds.fast;
      result = seek(sensors);
      break;
    case Step::settle:
      speed = 0;
      if (demand.velocity == 0) settle(sensors);
      break;
    case Step::go_back:
      if (sensors.active(method_.seeks)) approach_edge();
      break;
    case Step::leave:
      if (sensors.active(method_.seeks)) break;
      direction_ = method_.last;
      step_ = Step::cross;
      break;
    case Step::cross:
      result = cross(sensors);
      break;
    case Step::index:
      if (!sensors.index()) break;
      reference_ = *sensors.index();
      result = Result::found;
      break;
  }
  if (step_ != Step::seek && step_ != Step::settle && blocked(sensors)) result = Result::failed;
  if (result == Result::running) ramp_velocity(demand, direction_ * speed, ramps, h);
  return result;
}

SwitchSearch::Result SwitchSearch::seek(const TravelSensors& sensors) noexcept {
  if (sensors.active(method_.seeks) || sensors.edge(method_.seeks) != EdgeKind::none) {
    step_ = Step::settle;
    return Result::running;
  }
  if (!blocked(sensors)) return Result::running;
  if (turned_) return Result::failed;
  turned_ = true;
  direction_ = -direction_;
  return Result::running;
}

/// Chooses the next stage when the axis is at rest. The axis is then on the switch, or has passed a
/// narrow switch.
void SwitchSearch::settle(const TravelSensors& sensors) noexcept {
  if (sensors.active(method_.seeks)) return approach_edge();
  direction_ = -direction_;
  step_ = Step::go_back;
}

/// Chooses the next stage when the axis is on the switch.
void SwitchSearch::approach_edge() noexcept {
  step_ = method_.enters ? Step::leave : Step::cross;
  direction_ = method_.enters ? -method_.last : method_.last;
}

SwitchSearch::Result SwitchSearch::cross(const TravelSensors& sensors) noexcept {
  const EdgeKind wanted = method_.enters ? EdgeKind::rising : EdgeKind::falling;
  if (sensors.edge(method_.seeks) != wanted) return Result::running;
  reference_ = sensors.edge_at(method_.seeks);
  if (!method_.with_index) return Result::found;
  step_ = Step::index;
  return Result::running;
}

}  // namespace takt::sim
