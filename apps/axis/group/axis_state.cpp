#include "apps/axis/group/axis_state.hpp"

#include <cmath>
#include <utility>

#include "apps/axis/group/find_axes.hpp"
#include "apps/axis/group/signal_format.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

/// Largest permitted distance, in counts, between target and actual position of a drive that is not
/// enabled. If the distance is larger in more than `most_lagging` images in sequence, this program
/// sends the target position.
constexpr double most_counts_apart = 100;
constexpr int most_lagging = 4;
// Bit 4 of the controlword in these modes.
constexpr std::uint16_t homing_start = 0x10;
constexpr std::uint16_t enable_interpolation = 0x10;

constexpr std::uint16_t enable_operation = 0x000F;  // command in the controlword
constexpr std::uint16_t stays_halted = 0x100;       // bit of the controlword, in all modes

/// Returns true if drives follow the target position in this mode.
bool is_position_mode(std::int8_t mode) noexcept {
  return mode == std::to_underlying(DriveMode::profile_position) ||
         mode == std::to_underlying(DriveMode::interpolated_position) ||
         mode == std::to_underlying(DriveMode::cyclic_position);
}

bool missing(AxisSignals::Position signal, const ImageInput& input) {
  return signal && input.stale(*signal);
}

/// Returns true if the image carries a target position and a controlword that enables operation, so
/// that the drive follows this target.
bool shows_set_points(const AxisSignals& signals, const ImageInput& input) {
  const std::int64_t controlword = input.values()[*signals.controlword];
  return signals.target_position && (controlword & enable_operation) == enable_operation;
}

}  // namespace

void AxisControl::State::set_layout(const ImageInput& input) {
  std::vector<ValueFormat> formats;
  for (const signal_t& signal : input.signals()) formats.push_back(format_of(signal));
  units = Units{formats};
  axes.clear();
  for (AxisSignals& signals : find_axes(input.signals())) {
    Axis& axis = axes.emplace_back();
    axis.signals = std::move(signals);
    axis.commanded_mode = mode_for(axis.signals, mode_of_new_axes);
  }
  for (Eigen::VectorXd* values : {&positions, &velocities, &torques, &sent_positions,
                                  &target_positions, &target_velocities, &target_torques}) {
    values->setZero(size());
  }
}

double AxisControl::State::read(AxisSignals::Position signal, const ImageInput& input) const {
  return signal ? to_si(*signal, input.values()[*signal]) : 0.0;
}

double AxisControl::State::to_si(std::size_t signal, std::int64_t raw) const {
  const ValueFormat& format = units.format(signal);
  return number_of(format.type, raw) * format.scale + format.offset;
}

Eigen::VectorXd AxisControl::State::target_positions_in_counts() const {
  Eigen::VectorXd shown{Eigen::VectorXd::Zero(size())};
  for (Index i = 0; i < size(); ++i) {
    const AxisSignals::Position signal = axes[static_cast<std::size_t>(i)].signals.target_position;
    if (signal) shown(i) = to_si(*signal, units.to_raw(*signal, target_positions(i)));
  }
  return shown;
}

void AxisControl::State::on_image(const ImageInput& input) {
  for (Index i = 0; i < size(); ++i) {
    Axis& axis = at(i);
    positions(i) = read(axis.signals.position, input);
    velocities(i) = read(axis.signals.velocity, input);
    torques(i) = read(axis.signals.torque, input);
    sent_positions(i) = read(axis.signals.target_position, input);
    step(axis, input);
    rest(i, input);
  }
  command.session = input.session();
  command.cycle = input.cycle();
}

void AxisControl::State::step(Axis& axis, const ImageInput& input) {
  axis.stale = missing(axis.signals.statusword, input) || missing(axis.signals.position, input);
  const auto mode = axis.signals.mode_display ? axis.signals.mode_display : axis.signals.mode;
  if (mode) axis.shown_mode = static_cast<std::int8_t>(input.values()[*mode]);
  if (missing(axis.signals.statusword, input)) return;  // The axis keeps its controlword.
  axis.statusword = static_cast<std::uint16_t>(input.values()[*axis.signals.statusword]);
  const bool known = axis.seeded || !missing(axis.signals.position, input);
  const bool placed = known && axis.lagging == 0;
  axis.controlword = axis.drive.step(axis.statusword, placed ? Enabling::goes_on : Enabling::waits);
  if (!axis.drive.enabled()) axis.homes = false;
  if (axis.commanded_mode == DriveMode::profile_position && axis.drive.enabled()) {
    axis.controlword |= axis.handshake.step(axis.statusword);
  }
  if (axis.homes) axis.controlword |= homing_start;
  if (axis.halts && axis.drive.enabled()) axis.controlword |= stays_halted;
  const bool enables = (axis.controlword & enable_operation) == enable_operation;
  if (axis.commanded_mode == DriveMode::interpolated_position && enables) {
    axis.controlword |= enable_interpolation;
  }
}

/// Returns true if the axis is in Operation enabled and in a position mode, both as commanded and
/// as the image shows.
bool AxisControl::State::takes_positions(const Axis& axis) const noexcept {
  const bool shown = axis.signals.mode_display || axis.signals.mode;
  return axis.drive.enabled() && is_position_mode(std::to_underlying(axis.commanded_mode)) &&
         (!shown || is_position_mode(axis.shown_mode));
}

void AxisControl::State::rest(Index index, const ImageInput& input) {
  Axis& axis = at(index);
  if (!axis.drive.enabled() || (axis.signals.position && !axis.seeded)) {
    target_velocities(index) = 0.0;
    target_torques(index) = 0.0;
  }
  const bool takes = takes_positions(axis);
  if (takes && axis.seeded) return;
  const bool goes_on = takes && shows_set_points(axis.signals, input);
  if (goes_on) {
    target_positions(index) = sent_positions(index);
  } else if (axis.signals.position) {
    target_positions(index) = positions(index);
  }
  axis.seeded |= !axis.stale && (goes_on || axis.signals.position);
}

void AxisControl::State::make_controls(std::span<const Index> chosen) {
  command.schema = message_schema;
  command.signals.clear();
  command.values.clear();
  for (const Index i : chosen) {
    const Axis& axis = at(i);
    put(axis.signals.controlword, axis.controlword);
    put(axis.signals.mode, std::to_underlying(axis.commanded_mode));
    put_si(axis.signals.target_velocity, target_velocities(i));
    put_si(axis.signals.target_torque, target_torques(i));
    put_position(i);
  }
  command.num_values = static_cast<std::int32_t>(command.values.size());
}

/// taktd commands the target position again as soon as the drive is in cyclic synchronous position
/// mode. Drives read a set-point of profile position mode only when the handshake begins.
void AxisControl::State::put_position(Index index) {
  Axis& axis = at(index);
  axis.lagging = lags(index) ? axis.lagging + 1 : 0;
  axis.sends_position |=
      axis.commanded_mode == DriveMode::profile_position || axis.lagging > most_lagging;
  if (!axis.sends_position || !axis.seeded) return;
  const bool waits = !axis.handshake.taken() || !axis.signals.position;
  put_si(axis.signals.target_position, waits ? target_positions(index) : positions(index));
  const bool is_cyclic = axis.commanded_mode != DriveMode::profile_position &&
                         is_position_mode(std::to_underlying(axis.commanded_mode));
  const bool has_mode = axis.signals.mode_display || axis.signals.mode;
  const bool is_shown = !has_mode || axis.shown_mode == std::to_underlying(axis.commanded_mode);
  if (is_cyclic && is_shown && axis.drive.enabled()) axis.sends_position = false;
}

/// Returns true if a drive that is not enabled would jump when it is enabled, because its target
/// position is far from its actual one. taktd lets the target follow the actual position from the
/// first command on, unless another program has commanded a target before.
bool AxisControl::State::lags(Index index) const {
  const Axis& axis = axes[static_cast<std::size_t>(index)];
  if (axis.drive.enabled() || axis.stale || !axis.signals.position) return false;
  if (!axis.signals.target_position) return false;
  const double count = std::abs(units.format(*axis.signals.target_position).scale);
  return std::abs(sent_positions(index) - positions(index)) > most_counts_apart * count;
}

bool AxisControl::State::in_mode(const Axis& axis) const noexcept {
  if (!axis.signals.mode_display) return axis.signals.mode.has_value();
  return axis.shown_mode == std::to_underlying(axis.commanded_mode);
}

void AxisControl::State::make_command() {
  command.schema = message_schema;
  command.signals.clear();
  command.values.clear();
  for (Index i = 0; i < size(); ++i) {
    const Axis& axis = at(i);
    put(axis.signals.controlword, axis.controlword);
    put(axis.signals.mode, std::to_underlying(axis.commanded_mode));
    if (axis.seeded) put_si(axis.signals.target_position, target_positions(i));
    put_si(axis.signals.target_velocity, target_velocities(i));
    put_si(axis.signals.target_torque, target_torques(i));
    put_si(axis.signals.velocity_offset, 0.0);
    put_si(axis.signals.torque_offset, 0.0);
  }
  command.num_values = static_cast<std::int32_t>(command.values.size());
}

void AxisControl::State::put(AxisSignals::Position signal, std::int64_t raw) {
  if (!signal) return;
  command.signals.push_back(static_cast<std::int32_t>(*signal));
  command.values.push_back(raw);
}

void AxisControl::State::put_si(AxisSignals::Position signal, double si) {
  if (signal) put(signal, units.to_raw(*signal, si));
}

void AxisControl::State::set_positions(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    Axis& axis = at(i);
    const bool takes = !axis.signals.position || (axis.seeded && takes_positions(axis));
    if (!takes || !std::isfinite(si(i))) continue;
    target_positions(i) = si(i);
    axis.seeded = true;
  }
}

}  // namespace takt
