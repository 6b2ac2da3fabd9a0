#include <takt/motion.hpp>
#include <utility>

#include "apps/axis/axes_state.hpp"

namespace takt {
namespace {

/// Returns one value for each axis. After a restart of taktd, the places of the axes in the
/// messages are unknown, and all values are 0.
template <class State, class Value>
Eigen::VectorXd of_each(const State& state, Value value) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(state.size());
  if (!state.is_current() || state.speed) return values;
  for (Eigen::Index i = 0; i < state.size(); ++i) values(i) = value(state.in_group(i));
  return values;
}

}  // namespace

Axes::Axes(std::unique_ptr<State> state) : state_{std::move(state)} {}
Axes::Axes(Axes&& other) noexcept = default;

Axes& Axes::operator=(Axes&& other) noexcept {
  Axes old{std::move(*this)};  // disables its axes at the end of this call
  state_ = std::move(other.state_);
  return *this;
}

Axes::~Axes() {
  if (!state_) return;
  // A destructor cannot report an obstacle, so the result is not used.
  [[maybe_unused]] const Done done = disable();
}

std::expected<Axes, Obstacle> Axes::open(AxesOptions options) {
  auto lcm = open_lcm(options.lcm_url);
  if (!lcm) return obstacle(Obstacle::Kind::no_bus, lcm.error());
  return open(std::move(*lcm), std::move(options));
}

std::expected<Axes, Obstacle> Axes::open(std::unique_ptr<Transport> lcm, AxesOptions options,
                                         const EnvelopeKey* key) {
  auto state = std::make_unique<State>(std::move(lcm), std::move(options));
  if (key != nullptr) state->group.sign_with(*key);
  if (Done found = state->find(); !found) return std::unexpected{std::move(found.error())};
  return Axes{std::move(state)};
}

Done Axes::enable() { return state_->speed ? state_->enable_speed() : state_->enable(); }
Done Axes::disable() { return state_->speed ? state_->disable_speed() : state_->disable(); }
Done Axes::reset() { return state_->speed ? state_->reset_speed() : state_->reset(); }
Done Axes::home(const HomingOptions& options) {
  return state_->speed ? state_->no_position() : state_->home(options);
}
Done Axes::halt() { return state_->speed ? state_->no_drive() : state_->halt(); }
Done Axes::resume() { return state_->speed ? state_->no_drive() : state_->resume(); }
Done Axes::quick_stop() { return state_->speed ? state_->no_drive() : state_->quick_stop(); }
Done Axes::set_mode(Eigen::Index axis, DriveMode mode) {
  return state_->speed ? state_->no_drive() : state_->set_mode(axis, mode);
}
Done Axes::profile_move(const Eigen::Ref<const Eigen::VectorXd>& positions,
                        const ProfileBounds& bounds, const ProfileMove& how) {
  return state_->speed ? state_->no_position() : state_->profile_move(positions, bounds, how);
}
Done Axes::command_velocities(const Eigen::Ref<const Eigen::VectorXd>& velocities) {
  return state_->speed ? state_->no_drive() : state_->command_velocities(velocities);
}
Done Axes::command_torques(const Eigen::Ref<const Eigen::VectorXd>& torques) {
  return state_->speed ? state_->no_drive() : state_->command_torques(torques);
}
std::expected<double, Obstacle> Axes::touch_probe(Eigen::Index axis, const ProbeOptions& options) {
  if (state_->speed) return std::unexpected{state_->no_position().error()};
  return state_->touch_probe(axis, options);
}
std::expected<double, Obstacle> Axes::signal(const std::string& name) {
  return state_->signal(name);
}
Done Axes::set(const std::string& name, double value) { return state_->set(name, value); }
Done Axes::stop() { return state_->speed ? state_->stop_speed() : state_->stop(); }
Done Axes::set_mode(DriveMode mode) {
  return state_->speed ? state_->no_position() : state_->set_mode(mode);
}
Done Axes::wait(std::chrono::nanoseconds longest) {
  return state_->speed ? state_->wait_speed(longest) : state_->wait(longest);
}
Done Axes::run(std::chrono::nanoseconds time) { return state_->run(time); }

Done Axes::begin_move(const Eigen::Ref<const Eigen::VectorXd>& positions,
                      const MotionBounds& bounds) {
  if (state_->speed) return state_->no_position();
  return state_->begin("move", positions, bounds);
}

Done Axes::move(const Eigen::Ref<const Eigen::VectorXd>& positions, const MotionBounds& bounds) {
  if (Done begun = begin_move(positions, bounds); !begun) return begun;
  return wait();
}

Done Axes::move_by(const Eigen::Ref<const Eigen::VectorXd>& distances, const MotionBounds& bounds) {
  if (state_->speed) return state_->no_position();
  if (Done begun = state_->begin("move_by", distances, bounds); !begun) return begun;
  return wait();
}

Done Axes::jog(const Eigen::Ref<const Eigen::VectorXd>& velocities, const MotionBounds& bounds) {
  return state_->speed ? state_->run_speed(velocities, bounds) : state_->jog(velocities, bounds);
}

Done Axes::gear(const Gear& gear, const MotionBounds& bounds) {
  return state_->speed ? state_->no_position() : state_->gear(gear, bounds);
}

Done Axes::wait_locked(std::chrono::nanoseconds longest) {
  return state_->speed ? state_->no_position() : state_->wait_locked(longest);
}

Done Axes::begin_stream(const MotionBounds& bounds) {
  return state_->speed ? state_->no_position() : state_->begin_stream(bounds);
}

Done Axes::stream(std::span<const PathPoint> points) {
  return state_->speed ? state_->no_position() : state_->stream(points);
}

double Axes::stream_left() const { return state_->speed ? 0.0 : state_->stream_left(); }

bool Axes::locked() const { return !state_->speed && state_->locked(); }

Eigen::VectorXd Axes::phase_errors() const {
  return of_each(*state_, [&](Eigen::Index axis) {
    const auto motion = state_->group.motion(axis);
    return motion ? motion->phase_error : 0.0;
  });
}

Eigen::Index Axes::size() const noexcept { return state_->size(); }
bool Axes::has_positions() const noexcept { return !state_->speed; }
bool Axes::moving() const { return state_->speed ? state_->speed->moving() : state_->moving(); }
bool Axes::homed(Eigen::Index axis) const {
  return !state_->speed && state_->is_current() && state_->homed(state_->in_group(axis));
}
bool Axes::needs_homing(Eigen::Index axis) const {
  return !state_->speed && state_->is_current() && state_->needs_homing(state_->in_group(axis));
}
AxisGroup& Axes::group() noexcept { return state_->group; }

const std::string& Axes::name(Eigen::Index axis) const {
  return state_->names[static_cast<std::size_t>(axis)];
}

const std::string& Axes::unit(Eigen::Index axis) const {
  return state_->units[static_cast<std::size_t>(axis)];
}

Eigen::VectorXd Axes::positions() const {
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(*state_, [&](Eigen::Index axis) { return axes.positions()(axis); });
}

Eigen::VectorXd Axes::velocities() const {
  if (state_->speed) {
    Eigen::VectorXd speeds = Eigen::VectorXd::Zero(size());
    if (!state_->is_current()) return speeds;
    for (Eigen::Index i = 0; i < size(); ++i) speeds(i) = state_->speed->at(i).speed();
    return speeds;
  }
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(*state_, [&](Eigen::Index axis) { return axes.velocities()(axis); });
}

Eigen::VectorXd Axes::commanded_positions() const {
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(*state_, [&](Eigen::Index axis) {
    const auto motion = state_->group.motion(axis);
    return motion ? motion->position : axes.positions()(axis);
  });
}

Eigen::VectorXd Axes::following_errors() const {
  return of_each(*state_, [&](Eigen::Index axis) {
    const auto motion = state_->group.motion(axis);
    return motion ? motion->following_error : 0.0;
  });
}

}  // namespace takt
