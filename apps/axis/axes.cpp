#include <takt/motion.hpp>
#include <utility>

#include "apps/axis/axes_state.hpp"

namespace takt {
namespace {

template <class Value>
Eigen::VectorXd of_each(Eigen::Index size, Value value) {
  Eigen::VectorXd values{size};
  for (Eigen::Index i = 0; i < size; ++i) values(i) = value(i);
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
  if (state_) static_cast<void>(state_->disable());
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

Done Axes::enable() { return state_->enable(); }
Done Axes::disable() { return state_->disable(); }
Done Axes::reset() { return state_->reset(); }
Done Axes::set_mode(DriveMode mode) { return state_->set_mode(mode); }
Done Axes::stop() { return state_->stop(); }
Done Axes::wait(std::chrono::nanoseconds longest) { return state_->wait(longest); }
Done Axes::run(std::chrono::nanoseconds time) { return state_->run(time); }

Done Axes::begin_move(const Eigen::Ref<const Eigen::VectorXd>& positions,
                      const MotionBounds& bounds) {
  return state_->begin("move", positions, bounds);
}

Done Axes::move(const Eigen::Ref<const Eigen::VectorXd>& positions, const MotionBounds& bounds) {
  if (Done begun = begin_move(positions, bounds); !begun) return begun;
  return wait();
}

Done Axes::move_by(const Eigen::Ref<const Eigen::VectorXd>& distances, const MotionBounds& bounds) {
  if (distances.size() != size()) return begin_move(distances, bounds);  // says what is wrong
  return move(commanded_positions() + distances, bounds);
}

Done Axes::jog(const Eigen::Ref<const Eigen::VectorXd>& velocities, const MotionBounds& bounds) {
  return state_->jog(velocities, bounds);
}

Eigen::Index Axes::size() const noexcept { return state_->size(); }
bool Axes::moving() const { return state_->moving(); }
AxisGroup& Axes::group() noexcept { return state_->group; }

const std::string& Axes::name(Eigen::Index axis) const {
  return std::as_const(state_->group).axes().name(state_->in_group(axis));
}

const std::string& Axes::unit(Eigen::Index axis) const {
  const AxisGroup& group = state_->group;
  const AxisSignals& signals = group.axes().signals(state_->in_group(axis));
  return group.input().signals()[signals.position.value_or(*signals.controlword)].unit;
}

Eigen::VectorXd Axes::positions() const {
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(size(), [&](Eigen::Index i) { return axes.positions()(state_->in_group(i)); });
}

Eigen::VectorXd Axes::velocities() const {
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(size(), [&](Eigen::Index i) { return axes.velocities()(state_->in_group(i)); });
}

Eigen::VectorXd Axes::commanded_positions() const {
  const AxisControl& axes = std::as_const(state_->group).axes();
  return of_each(size(), [&](Eigen::Index i) {
    const Eigen::Index axis = state_->in_group(i);
    const auto motion = state_->group.motion(axis);
    return motion ? motion->position : axes.positions()(axis);
  });
}

Eigen::VectorXd Axes::following_errors() const {
  return of_each(size(), [&](Eigen::Index i) {
    const auto motion = state_->group.motion(state_->in_group(i));
    return motion ? motion->following_error : 0.0;
  });
}

}  // namespace takt
