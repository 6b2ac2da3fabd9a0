#include "apps/takt/soak/homing_program.hpp"

#include <chrono>

#include "apps/axis/group/surroundings.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr Time until_bus_comes = 10'000h;
constexpr Time longest_call = 8s;
constexpr Time longest_rest = 400ms;
constexpr Time longest_jog = 600ms;
constexpr double acceleration = 30.0;
constexpr double farthest = 4.0;

}  // namespace

bool HomingProgram::open() {
  axes_.reset();
  auto opened = Axes::open(setting_.connect(), {.bus = setting_.bus,
                                                .names = setting_.axes,
                                                .sender = "homing",
                                                .longest = until_bus_comes,
                                                .interrupted = setting_.is_killed});
  if (!opened) return false;
  axes_.emplace(std::move(*opened));
  return true;
}

void HomingProgram::run() {
  if (!open()) return;
  while (!setting_.is_killed()) {
    const Done done = act();
    if (!done && done.error().kind == Obstacle::Kind::restarted && !open()) return;
    [[maybe_unused]] const Done paused = axes_->run(random_.up_to(longest_rest));
  }
}

Done HomingProgram::told(const std::string& what, Done done) const {
  if (setting_.trace && !setting_.is_killed()) {
    setting_.trace(what + ": " + (done ? "done" : done.error().text));
  }
  return done;
}

Done HomingProgram::act() {
  if (Done enabled = told("enable", axes_->enable()); !enabled) {
    const bool lost = enabled.error().kind == Obstacle::Kind::restarted;
    return lost ? enabled : told("reset", axes_->reset());
  }
  switch (random_.below(10)) {
    case 0:
    case 1:
    case 2:
      return home();
    case 3:
    case 4:
    case 5:
      return move();
    case 6:
    case 7:
      return told("move_by", axes_->move_by(numbers(farthest / 4), bounds()));
    case 8:
      return told("disable", axes_->disable());
    default:
      return jog();
  }
}

Done HomingProgram::home() {
  const auto order = random_.chance(0.5) ? HomingOptions::Order::together
                                         : HomingOptions::Order::one_after_the_other;
  Done done = told("home", axes_->home({.order = order, .longest = longest_call}));
  if (done) ++homed_;
  return done;
}

Done HomingProgram::move() {
  const Time begin = surroundings().now();
  Done done = told("move", axes_->move(numbers(farthest), bounds()));
  if (!done || setting_.is_killed()) return done;
  ++arrived_;
  for (const std::size_t axis : setting_.numbers) judge_.arrived(axis, begin);
  return done;
}

Done HomingProgram::jog() {
  if (Done begun = told("jog", axes_->jog(numbers(velocity), bounds())); !begun) return begun;
  if (Done ran = axes_->run(random_.up_to(longest_jog)); !ran) return ran;
  return told("stop", axes_->stop());
}

takt::MotionBounds HomingProgram::bounds() const {
  return {.velocity = Eigen::VectorXd::Constant(1, velocity),
          .acceleration = Eigen::VectorXd::Constant(1, acceleration)};
}

/// Returns one number for each axis, from -largest to largest.
Eigen::VectorXd HomingProgram::numbers(double largest) {
  Eigen::VectorXd all(axes_->size());
  for (double& one : all) one = largest * (1e-6 * random_.below(2'000'001) - 1.0);
  return all;
}

}  // namespace takt::soak
