#include <algorithm>
#include <cmath>
#include <takt/axis_control.hpp>
#include <utility>

#include "apps/axis/group/axis_state.hpp"

namespace takt {
namespace {

double finite_or_zero(double si) noexcept { return std::isfinite(si) ? si : 0.0; }

}  // namespace

AxisControl::AxisControl() : state_{std::make_unique<State>()} {}
AxisControl::~AxisControl() = default;
AxisControl::AxisControl(AxisControl&& other) noexcept = default;
AxisControl& AxisControl::operator=(AxisControl&& other) noexcept = default;

void AxisControl::set_layout(const ImageInput& input) { state_->set_layout(input); }
void AxisControl::on_image(const ImageInput& input) { state_->on_image(input); }

command_t& AxisControl::command() {
  state_->make_command();
  return state_->command;
}

command_t& AxisControl::controls(std::span<const Index> axes) {
  state_->make_controls(axes);
  return state_->command;
}

AxisControl::Index AxisControl::size() const noexcept { return state_->size(); }
const AxisSignals& AxisControl::signals(Index axis) const { return state_->at(axis).signals; }
const DriveSequence& AxisControl::drive(Index axis) const { return state_->at(axis).drive; }
std::uint16_t AxisControl::statusword(Index axis) const { return state_->at(axis).statusword; }
bool AxisControl::stale(Index axis) const { return state_->at(axis).stale; }

const Eigen::VectorXd& AxisControl::positions() const noexcept { return state_->positions; }
const Eigen::VectorXd& AxisControl::velocities() const noexcept { return state_->velocities; }
const Eigen::VectorXd& AxisControl::torques() const noexcept { return state_->torques; }
const Eigen::VectorXd& AxisControl::sent_positions() const noexcept {
  return state_->sent_positions;
}
const Eigen::VectorXd& AxisControl::target_positions() const noexcept {
  return state_->target_positions;
}
Eigen::VectorXd AxisControl::target_positions_in_counts() const {
  return state_->target_positions_in_counts();
}

void AxisControl::set_goal(Index axis, DriveGoal goal) { state_->at(axis).drive.set_goal(goal); }
void AxisControl::set_positions(const Eigen::Ref<const Eigen::VectorXd>& si) {
  state_->set_positions(si);
}

bool AxisControl::any_stale() const noexcept {
  return std::ranges::any_of(state_->axes, [](const State::Axis& axis) { return axis.stale; });
}

bool AxisControl::all_enabled() const noexcept {
  return std::ranges::all_of(state_->axes,
                             [](const State::Axis& axis) { return axis.drive.enabled(); });
}

bool AxisControl::all_reached() const noexcept {
  return std::ranges::all_of(state_->axes,
                             [](const State::Axis& axis) { return axis.drive.reached(); });
}

void AxisControl::set_goal(DriveGoal goal) {
  for (State::Axis& axis : state_->axes) axis.drive.set_goal(goal);
}

void AxisControl::reset_fault(Index axis) { state_->at(axis).drive.reset_fault(); }

void AxisControl::reset_faults() {
  for (State::Axis& axis : state_->axes) axis.drive.reset_fault();
}

bool AxisControl::in_mode() const noexcept {
  return std::ranges::all_of(state_->axes,
                             [this](const State::Axis& axis) { return state_->in_mode(axis); });
}

bool AxisControl::in_mode(Index axis) const { return state_->in_mode(state_->at(axis)); }

void AxisControl::set_velocities(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    if (drive(i).enabled()) state_->target_velocities(i) = finite_or_zero(si(i));
  }
}

void AxisControl::set_torques(const Eigen::Ref<const Eigen::VectorXd>& si) {
  for (Index i = 0; i < size(); ++i) {
    if (drive(i).enabled()) state_->target_torques(i) = finite_or_zero(si(i));
  }
}

void AxisControl::set_mode(DriveMode mode) noexcept {
  state_->mode_of_new_axes = mode;
  for (Index i = 0; i < size(); ++i) set_mode(i, mode);
}

void AxisControl::set_mode(Index axis, DriveMode mode) noexcept {
  State::Axis& of = state_->at(axis);
  const DriveMode possible = State::mode_for(of.signals, mode);
  if (possible != of.commanded_mode) {
    state_->target_velocities(axis) = 0.0;
    state_->target_torques(axis) = 0.0;
  }
  of.commanded_mode = possible;
  if (mode != DriveMode::profile_position) of.handshake = {};
  if (mode != DriveMode::homing) of.homes = false;
}

DriveMode AxisControl::mode(Index axis) const { return state_->at(axis).commanded_mode; }

void AxisControl::start_homing(Index axis) {
  State::Axis& of = state_->at(axis);
  of.homes = of.drive.enabled() && of.commanded_mode == DriveMode::homing;
}

void AxisControl::end_homing(Index axis) { state_->at(axis).homes = false; }

void AxisControl::halt(Index axis) { state_->at(axis).halts = true; }

void AxisControl::end_halt(Index axis) { state_->at(axis).halts = false; }

void AxisControl::begin_set_points() {
  for (State::Axis& axis : state_->axes) {
    if (axis.commanded_mode == DriveMode::profile_position) axis.handshake.begin();
  }
}

void AxisControl::begin_set_point(Index axis, SetPointTiming timing) {
  State::Axis& of = state_->at(axis);
  if (of.commanded_mode == DriveMode::profile_position) of.handshake.begin(timing);
}

bool AxisControl::set_point_taken(Index axis) const { return state_->at(axis).handshake.taken(); }

bool AxisControl::set_points_taken() const noexcept {
  return std::ranges::all_of(state_->axes,
                             [](const State::Axis& axis) { return axis.handshake.done(); });
}

}  // namespace takt
