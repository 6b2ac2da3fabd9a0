#include "apps/axis/axis_control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

ValueFormat format_of(const signal_t& signal) {
  const bool usable = std::isfinite(signal.scale) && signal.scale != 0.0 &&
                      std::isfinite(signal.offset) && signal.bits >= 1 && signal.bits <= 64;
  if (!usable) return {};
  return {.type = static_cast<DataType>(signal.data_type),
          .bits = static_cast<std::uint8_t>(signal.bits),
          .scale = signal.scale,
          .offset = signal.offset};
}

/// Returns true if drives obey the target position 0x607A in this mode.
bool is_position_mode(std::int8_t mode) noexcept {
  return mode == std::to_underlying(DriveMode::profile_position) ||
         mode == std::to_underlying(DriveMode::cyclic_position);
}

double finite_or_zero(double si) noexcept { return std::isfinite(si) ? si : 0.0; }

bool missing(AxisSignals::Position signal, const ImageInput& input) {
  return signal && input.stale(*signal);
}

/// Returns true if the image carries a target position and a controlword that enables operation, so
/// that the drive obeys this target.
bool shows_set_points(const AxisSignals& signals, const ImageInput& input) {
  constexpr std::int64_t enable_operation = 0x000F;
  const std::int64_t controlword = input.values()[*signals.controlword];
  return signals.target_position && (controlword & enable_operation) == enable_operation;
}

}  // namespace

void AxisControl::set_layout(const ImageInput& input) {
  std::vector<ValueFormat> formats;
  for (const signal_t& signal : input.signals()) formats.push_back(format_of(signal));
  units_ = Units{formats};
  axes_.clear();
  for (AxisSignals& signals : find_axes(input.signals())) {
    Axis& axis = axes_.emplace_back();
    axis.signals = std::move(signals);
  }
  for (Eigen::VectorXd* values : {&positions_, &velocities_, &torques_, &sent_positions_,
                                  &target_positions_, &target_velocities_, &target_torques_}) {
    values->setZero(size());
  }
}

double AxisControl::read(AxisSignals::Position signal, const ImageInput& input) const {
  return signal ? to_si(*signal, input.values()[*signal]) : 0.0;
}

double AxisControl::to_si(std::size_t signal, std::int64_t raw) const {
  const ValueFormat& format = units_.format(signal);
  return number_of(format.type, raw) * format.scale + format.offset;
}

Eigen::VectorXd AxisControl::target_positions_in_counts() const {
  Eigen::VectorXd shown{Eigen::VectorXd::Zero(size())};
  for (Index i = 0; i < size(); ++i) {
    const AxisSignals::Position signal = signals(i).target_position;
    if (signal) shown(i) = to_si(*signal, units_.to_raw(*signal, target_positions_(i)));
  }
  return shown;
}

void AxisControl::on_image(const ImageInput& input) {
  for (Index i = 0; i < size(); ++i) {
    Axis& axis = axes_[at(i)];
    positions_(i) = read(axis.signals.position, input);
    velocities_(i) = read(axis.signals.velocity, input);
    torques_(i) = read(axis.signals.torque, input);
    sent_positions_(i) = read(axis.signals.target_position, input);
    step(axis, input);
    rest(i, input);
  }
  command_.session = input.session();
  command_.cycle = input.cycle();
}

void AxisControl::step(Axis& axis, const ImageInput& input) {
  axis.stale = missing(axis.signals.statusword, input) || missing(axis.signals.position, input);
  const auto mode = axis.signals.mode_display ? axis.signals.mode_display : axis.signals.mode;
  if (mode) axis.shown_mode = static_cast<std::int8_t>(input.values()[*mode]);
  if (missing(axis.signals.statusword, input)) return;  // The last controlword is held.
  axis.statusword = static_cast<std::uint16_t>(input.values()[*axis.signals.statusword]);
  const bool placed = axis.seeded || !missing(axis.signals.position, input);
  axis.controlword = axis.drive.step(axis.statusword, placed ? Enabling::goes_on : Enabling::waits);
  if (mode_ == DriveMode::profile_position && axis.drive.enabled()) {
    axis.controlword |= axis.handshake.step(axis.statusword);
  }
}

/// Returns true if the axis is in Operation enabled and in a position mode, both as commanded and
/// as the image shows.
bool AxisControl::takes_positions(const Axis& axis) const noexcept {
  const bool shown = axis.signals.mode_display || axis.signals.mode;
  return axis.drive.enabled() && is_position_mode(std::to_underlying(mode_)) &&
         (!shown || is_position_mode(axis.shown_mode));
}

void AxisControl::rest(Index index, const ImageInput& input) {
  Axis& axis = axes_[at(index)];
  if (!axis.drive.enabled() || (axis.signals.position && !axis.seeded)) {
    target_velocities_(index) = 0.0;
    target_torques_(index) = 0.0;
  }
  const bool takes = takes_positions(axis);
  if (takes && axis.seeded) return;
  const bool goes_on = takes && shows_set_points(axis.signals, input);
  if (goes_on) {
    target_positions_(index) = sent_positions_(index);
  } else if (axis.signals.position) {
    target_positions_(index) = positions_(index);
  }
  axis.seeded |= !axis.stale && (goes_on || axis.signals.position);
}

command_t& AxisControl::command() {
  command_.schema = message_schema;
  command_.signals.clear();
  command_.values.clear();
  for (Index i = 0; i < size(); ++i) {
    const Axis& axis = axes_[at(i)];
    put(axis.signals.controlword, axis.controlword);
    put(axis.signals.mode, std::to_underlying(mode_));
    if (axis.seeded) put_si(axis.signals.target_position, target_positions_(i));
    put_si(axis.signals.target_velocity, target_velocities_(i));
    put_si(axis.signals.target_torque, target_torques_(i));
    put_si(axis.signals.velocity_offset, 0.0);
    put_si(axis.signals.torque_offset, 0.0);
  }
  command_.num_values = static_cast<std::int32_t>(command_.values.size());
  return command_;
}

void AxisControl::put(AxisSignals::Position signal, std::int64_t raw) {
  if (!signal) return;
  command_.signals.push_back(static_cast<std::int32_t>(*signal));
  command_.values.push_back(raw);
}

void AxisControl::put_si(AxisSignals::Position signal, double si) {
  if (signal) put(signal, units_.to_raw(*signal, si));
}

bool AxisControl::any_stale() const noexcept {
  return std::ranges::any_of(axes_, [](const Axis& axis) { return axis.stale; });
}

bool AxisControl::all_enabled() const noexcept {
  return std::ranges::all_of(axes_, [](const Axis& axis) { return axis.drive.enabled(); });
}

bool AxisControl::all_reached() const noexcept {
  return std::ranges::all_of(axes_, [](const Axis& axis) { return axis.drive.reached(); });
}

void AxisControl::set_goal(DriveGoal goal) {
  for (Axis& axis : axes_) axis.drive.set_goal(goal);
}

void AxisControl::reset_faults() {
  for (Axis& axis : axes_) axis.drive.reset_fault();
}

bool AxisControl::in_mode() const noexcept {
  return std::ranges::all_of(axes_, [this](const Axis& axis) {
    if (!axis.signals.mode_display) return axis.signals.mode.has_value();
    return axis.shown_mode == std::to_underlying(mode_);
  });
}

void AxisControl::set_positions(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    Axis& axis = axes_[at(i)];
    const bool takes = !axis.signals.position || (axis.seeded && takes_positions(axis));
    if (!takes || !std::isfinite(si(i))) continue;
    target_positions_(i) = si(i);
    axis.seeded = true;
  }
}

void AxisControl::set_velocities(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    if (drive(i).enabled()) target_velocities_(i) = finite_or_zero(si(i));
  }
}

void AxisControl::set_torques(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    if (drive(i).enabled()) target_torques_(i) = finite_or_zero(si(i));
  }
}

void AxisControl::set_mode(DriveMode mode) noexcept {
  mode_ = mode;
  if (mode == DriveMode::profile_position) return;
  for (Axis& axis : axes_) axis.handshake = {};
}

void AxisControl::begin_set_points() {
  if (mode_ != DriveMode::profile_position) return;
  for (Axis& axis : axes_) axis.handshake.begin();
}

bool AxisControl::set_points_taken() const noexcept {
  return std::ranges::all_of(axes_, [](const Axis& axis) { return axis.handshake.done(); });
}

}  // namespace takt
