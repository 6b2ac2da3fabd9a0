#include "master/sim/axis/homing.hpp"

#include <algorithm>
#include <optional>

namespace takt::sim {
namespace {

constexpr std::uint16_t start_bit = 0x10;
constexpr std::uint16_t reached = 0x0400;
constexpr std::uint16_t attained = 0x1000;
constexpr std::uint16_t error = 0x2000;
constexpr double default_speed = 10'000;
constexpr double index_time = 0.02;  // seconds at the slow speed from the switch to the index pulse

/// Returns the first direction of motion of a method, or std::nullopt if the method is not
/// supported.
std::optional<double> direction_of(std::int64_t method) noexcept {
  if (method == 33 || method == 34) return method == 33 ? -1.0 : 1.0;
  if (method >= 17 && method <= 30) method -= 16;
  if (method < 1 || method > 14) return std::nullopt;
  const bool negative = method == 1 || method == 5 || method == 6 || method >= 11;
  return negative ? -1.0 : 1.0;
}

/// Returns true if the drive has this method. A drive without a list (0x60E3) has all methods that
/// the model supports.
bool lists(const AxisObjects& objects, std::int64_t method) noexcept {
  const auto is_method = [method](const Slot& slot) { return slot.get() == method; };
  return objects.homing_methods.empty() || std::ranges::any_of(objects.homing_methods, is_method);
}

bool is_current_position(std::int64_t method) noexcept { return method == 35 || method == 37; }

}  // namespace

void Homing::on_controlword(std::uint16_t before, std::uint16_t now,
                            const Demand& demand) noexcept {
  const bool running = stage_ == Stage::seek || stage_ == Stage::leave || stage_ == Stage::search;
  if ((now & start_bit) == 0 && running) stage_ = Stage::idle;
  if ((~before & now & start_bit) == 0) return;
  const std::int64_t method = objects_.homing_method.get();
  reference_ = switch_at_ = demand.position;
  if (!lists(objects_, method)) {
    stage_ = Stage::failed;
    return;
  }
  if (is_current_position(method)) {
    stage_ = Stage::stop;
    return;
  }
  if (begins_search(method)) return;
  const auto direction = direction_of(method);
  stage_ = direction ? Stage::seek : Stage::failed;
  direction_ = direction.value_or(1.0);
  const double way = objects_.homing_speed_switch.positive_or(default_speed);
  const double part = 1.0 / 3.0 + static_cast<double>(random_.below(1000)) / 1500.0;
  switch_at_ += direction_ * way * part;
}

/// Begins a search with the sensors of the axis if they suffice for the method.
bool Homing::begins_search(std::int64_t method) noexcept {
  const auto how = homing_method(method);
  if (servo_ == nullptr || !how) return false;
  if (how->needs_switch && !servo_->sensors().has(how->seeks)) return false;
  search_.begin(*how, servo_->sensors());
  stage_ = Stage::search;
  return true;
}

void Homing::search(Demand& demand, const Ramps& ramps, double h) noexcept {
  const SearchSpeeds speeds{.fast = objects_.homing_speed_switch.positive_or(default_speed),
                            .slow = objects_.homing_speed_zero.positive_or(default_speed / 10)};
  switch (search_.step(servo_->sensors(), demand, speeds, ramps, h)) {
    case SwitchSearch::Result::running:
      return;
    case SwitchSearch::Result::found:
      reference_ = search_.reference() + servo_->origin();
      stage_ = Stage::stop;
      return;
    case SwitchSearch::Result::failed:
      stage_ = Stage::failed;
      return;
  }
}

bool Homing::step(Demand& demand, double deceleration, double h) noexcept {
  const double ramp = objects_.homing_acceleration.positive_or(1'000'000);
  const Ramps ramps{.acceleration = ramp, .deceleration = ramp};
  switch (stage_) {
    case Stage::seek:
    case Stage::leave:
      return seek(demand, ramps, h);
    case Stage::search:
      search(demand, ramps, h);
      return false;
    case Stage::stop:
      ramp_velocity(demand, 0, ramps, h);
      if (demand.velocity != 0) return false;
      stage_ = Stage::done;
      return true;
    case Stage::idle:
    case Stage::done:
    case Stage::failed:
      ramp_velocity(demand, 0, {.acceleration = deceleration, .deceleration = deceleration}, h);
      return false;
  }
  return false;
}

/// Moves fast to the switch, slowly back off it, and on to the index pulse if the method uses one.
bool Homing::seek(Demand& demand, const Ramps& ramps, double h) noexcept {
  const double slow = objects_.homing_speed_zero.positive_or(default_speed / 10);
  if (stage_ == Stage::seek) {
    const double fast = objects_.homing_speed_switch.positive_or(default_speed);
    ramp_velocity(demand, direction_ * fast, ramps, h);
    if ((demand.position - switch_at_) * direction_ >= 0) stage_ = Stage::leave;
    return false;
  }
  const std::int64_t method = objects_.homing_method.get();
  const bool with_index = method <= 14 || method >= 33;
  const double edge = switch_at_ - (with_index ? direction_ * slow * index_time : 0);
  ramp_velocity(demand, -direction_ * slow, ramps, h);
  if ((demand.position - edge) * direction_ > 0 || demand.velocity * direction_ > 0) return false;
  reference_ = edge;
  stage_ = Stage::stop;
  return false;
}

double Homing::shift() const noexcept {
  return -static_cast<double>(objects_.home_offset.get()) - reference_;
}

std::uint16_t Homing::status_bits(bool stands) const noexcept {
  switch (stage_) {
    case Stage::idle:
      return stands ? reached : 0;
    case Stage::done:
      return reached | attained;
    case Stage::failed:
      return stands ? error | reached : error;
    case Stage::seek:
    case Stage::leave:
    case Stage::search:
    case Stage::stop:
      return 0;
  }
  return 0;
}

}  // namespace takt::sim
