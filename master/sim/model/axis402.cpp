#include "master/sim/model/axis402.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace takt::sim {
namespace {

constexpr Time initialisation = std::chrono::milliseconds{10};
constexpr Time sync_is_gone = std::chrono::milliseconds{100};
constexpr std::uint16_t fault_reset = 0x80;
constexpr std::uint16_t lost_connection = 0x8100;

bool stays_in_quick_stop(std::int64_t option) noexcept { return option >= 5 && option <= 8; }

}  // namespace

Axis402::Axis402(ObjectStore& store, EmcyProducer& emcy, Random random, std::uint8_t number,
                 const MechanicsTable* mechanics)
    : objects_{store, static_cast<std::uint16_t>(0x800 * number)},
      emcy_{emcy},
      number_{number},
      profile_{objects_},
      homing_{objects_, random},
      points_{objects_} {
  motor_.position = static_cast<double>(objects_.position_actual.get());
  rated_acceleration_ = std::max(4 * objects_.profile_acceleration.positive_or(0), 1e6);
  if (mechanics == nullptr) return;
  servo_ = std::make_unique<AxisServo>(objects_, *mechanics, random.fork(1));
  servo_->shift(motor_.position);
  homing_.use(*servo_);
}

void Axis402::reset(Time now) noexcept {
  state_ = DriveState::not_ready;
  stopping_to_ = DriveState::operation_enabled;
  mode_ = DriveMode::none;
  controlword_ = static_cast<std::uint16_t>(objects_.controlword.get());
  fault_code_ = 0;
  following_error_ = settled_ = target_waits_ = false;
  demand_ = {motor_.position, 0};
  time_ = now;
  releases_ = blocked_ = interpolates_ = false;
  if (servo_) points_.clear();
  if (servo_) servo_->reset(now);
  last_sync_ = sync_distance_ = Time{};
  initialised_at_ = now + initialisation;
  publish();
}

/// Returns true if nothing changes until an object is written.
bool Axis402::idle() const noexcept {
  if (!settled_ || is_powered(state_) || state_ == DriveState::not_ready) return false;
  return servo_ ? servo_->servo().rests() : motor_.stands();
}

void Axis402::outputs(Time now) noexcept {
  follow_mode();
  follow_controlword();
  if (last_sync_ == Time{} || now - last_sync_ > sync_is_gone) {
    take_cyclic_target(interpolation_period());
  }
  publish_state();
  if (published_ != now || mode_ == DriveMode::homing) publish_motion();
}

void Axis402::on_sync(Time now) noexcept {
  if (last_sync_ != Time{}) sync_distance_ = now - last_sync_;
  last_sync_ = now;
  take_cyclic_target(interpolation_period());
}

double Axis402::interpolation_period() const noexcept {
  if (sync_distance_ > Time{} && sync_distance_ < std::chrono::seconds{1}) {
    return static_cast<double>(sync_distance_.count()) * 1e-9;
  }
  return reported_period();
}

/// Returns the interpolation time period 0x60C2, in seconds.
double Axis402::reported_period() const noexcept {
  const auto exponent = std::clamp<std::int64_t>(objects_.period_exponent.get(), -9, 0);
  const double reported = static_cast<double>(objects_.period_value.get()) *
                          std::pow(10.0, static_cast<double>(exponent));
  return std::clamp(reported, 0.001, 1.0);
}

void Axis402::take_cyclic_target(double period) noexcept {
  if (state_ != DriveState::operation_enabled) return;
  const bool interpolated = mode_ == DriveMode::interpolated_position;
  if (mode_ != DriveMode::cyclic_position && !interpolated) return;
  if (interpolated && !servo_ && (controlword_ & 0x10) == 0) return;
  const Slot& slot = interpolated ? objects_.interpolation_target : objects_.target_position;
  bool limited = false;
  const double wanted = static_cast<double>(slot.get() + objects_.position_offset.get());
  const double target = within_limits(objects_, wanted, limited);
  if (interpolated && servo_) {
    if (last_sync_ == time_ || target != points_.newest()) points_.add(target);
    return;
  }
  cyclic_.take(demand_, target, period, objects_.max_profile_velocity.positive_or(1e12));
}

Abort Axis402::check_write(const Object& object, std::uint64_t raw) const noexcept {
  if (!objects_.mode.is(object)) return Abort::none;
  return knows(static_cast<std::int8_t>(raw)) ? Abort::none : Abort::value;
}

bool Axis402::knows(std::int64_t mode) const noexcept {
  constexpr std::uint32_t built = 1 | 1 << 2 | 1 << 3 | 1 << 5 | 1 << 6 | 1 << 7 | 1 << 8 | 1 << 9;
  if (mode == 0) return true;
  if (mode < 1 || mode > 32) return false;
  const auto reported = static_cast<std::uint32_t>(objects_.supported_modes.get()) & 0xFFFF;
  const std::uint32_t supported = reported == 0 ? built : reported & built;
  return (supported >> (mode - 1) & 1) != 0;
}

void Axis402::follow_mode() noexcept {
  const std::int64_t wanted = objects_.mode.exists() ? objects_.mode.get() : 8;
  if (wanted == std::to_underlying(mode_) || !knows(wanted)) return;
  mode_ = static_cast<DriveMode>(wanted);
  start_mode();
}

void Axis402::start_mode() noexcept {
  published_ = never;
  if (!is_powered(state_)) demand_ = {motor_.position, 0};
  if (servo_ && is_powered(state_)) meet_motion();
  if (servo_ && mode_ == DriveMode::profile_position) demand_.velocity = 0;
  if (servo_) points_.clear();
  interpolates_ = false;
  profile_.start(demand_);
  homing_.start();
  cyclic_.start(demand_);
  on_target_ = false;
  target_time_ = following_time_ = Time{};
}

void Axis402::follow_controlword() noexcept {
  const std::uint16_t before = controlword_;
  controlword_ = static_cast<std::uint16_t>(objects_.controlword.get());
  if (state_ == DriveState::fault && (~before & controlword_ & fault_reset) != 0) reset_fault();
  const bool stays = stays_in_quick_stop(objects_.quick_stop_option.get());
  const DriveState next = commanded(state_, command_of(controlword_), stays);
  settled_ = next == state_;
  releases_ = waits_for_brake(next);
  if (releases_) return;
  go(next);
  if (state_ != DriveState::operation_enabled) return;
  if (mode_ == DriveMode::profile_position) {
    profile_.on_controlword(before, controlword_, demand_, motor_.position);
  }
  if (mode_ == DriveMode::homing) homing_.on_controlword(before, controlword_, demand_);
  if (mode_ == DriveMode::interpolated_position) {
    constexpr std::uint16_t enables = 0x10;
    if ((~before & controlword_ & enables) != 0) interpolates_ = true;
    if ((controlword_ & enables) == 0) interpolates_ = false;
  }
}

/// Returns true while the axis has to wait for its brake before it is enabled.
bool Axis402::waits_for_brake(DriveState next) const noexcept {
  return servo_ && next == DriveState::operation_enabled && !servo_->servo().released();
}

/// Sets the demand to the present motion, after the demand has followed the motion or deviated from
/// it.
void Axis402::meet_motion() noexcept {
  demand_ = servo_ ? servo_->demand() : Demand{motor_.position, motor_.velocity};
}

/// Enters the next state. Some transitions out of Operation enabled first stop the motor on a ramp.
void Axis402::go(DriveState next) noexcept {
  if (state_ != DriveState::operation_enabled) {
    if (next != state_) enter(next);
    return;
  }
  const bool disables = next == DriveState::switched_on && objects_.disable_option.get() != 0;
  const bool shuts_down = next == DriveState::ready && objects_.shutdown_option.get() != 0;
  if (disables || shuts_down || next == state_) {
    if (servo_ && next != stopping_to_ && next != state_ && !controls_position()) meet_motion();
    stopping_to_ = next;
    return;
  }
  const bool coasts = next == DriveState::quick_stop && objects_.quick_stop_option.get() == 0;
  enter(coasts ? DriveState::switch_on_disabled : next);
}

void Axis402::enter(DriveState next) noexcept {
  const bool was_powered = is_powered(state_);
  state_ = next;
  published_ = never;
  settled_ = false;
  stopping_to_ = DriveState::operation_enabled;
  if (!is_powered(next) || !was_powered) demand_ = {motor_.position, 0};
  const bool brakes = next == DriveState::quick_stop || next == DriveState::fault_reaction;
  if (brakes) meet_motion();
  if (next == DriveState::operation_enabled) start_mode();
}

void Axis402::reset_fault() noexcept {
  emcy_.clear(std::exchange(fault_code_, std::uint16_t{0}), axis_detail()[0]);
  objects_.error_code.set(0);
  following_error_ = false;
  enter(DriveState::switch_on_disabled);
}

void Axis402::fail(std::uint16_t code) noexcept {
  if (state_ == DriveState::fault || state_ == DriveState::fault_reaction) return;
  fault_code_ = code;
  objects_.error_code.set(code);
  emcy_.raise(code, code >> 8 == 0x81 ? ErrorBit::communication : ErrorBit::profile, axis_detail());
  const bool coasts = !is_powered(state_) || objects_.fault_option.get() == 0;
  enter(coasts ? DriveState::fault : DriveState::fault_reaction);
  publish();
}

/// Reacts as the abort connection option code 0x6007 says.
void Axis402::connection_lost() noexcept {
  if (!is_powered(state_) || state_ == DriveState::fault_reaction) return;
  switch (objects_.abort_connection.get()) {
    case 1:
      return fail(lost_connection);
    case 2:
      enter(DriveState::switch_on_disabled);
      break;
    case 3:
      if (state_ == DriveState::operation_enabled) enter(DriveState::quick_stop);
      break;
    default:
      break;
  }
  publish();
}

}  // namespace takt::sim
