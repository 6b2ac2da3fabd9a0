#include "master/motion/beat/axis_runner.hpp"

#include <algorithm>
#include <cmath>

#include "master/motion/beat/stop_profile.hpp"

namespace takt::motion {
namespace {

StopCause cause_of(AxisCondition condition) noexcept {
  switch (condition) {
    case AxisCondition::enabled:
      return StopCause::none;
    case AxisCondition::disabled:
      return StopCause::disabled;
    case AxisCondition::fault:
      return StopCause::fault;
    case AxisCondition::lost:
      return StopCause::node_lost;
  }
  return StopCause::none;
}

bool is_close(double a, double b, double size) noexcept {
  return std::abs(a - b) <= AxisRunner::start_tolerance * size;
}

bool has_same_motion(const State& a, const State& b, const Limits& limits) noexcept {
  return is_close(a.velocity, b.velocity, limits.max_velocity - limits.min_velocity) &&
         is_close(a.acceleration, b.acceleration,
                  limits.max_acceleration - limits.min_acceleration);
}

bool is_same(const State& a, const State& b, const Limits& limits) noexcept {
  return is_close(a.position, b.position, std::max(1.0, std::abs(b.position))) &&
         has_same_motion(a, b, limits);
}

bool ends_as_it_says(const MotionOrder& order) noexcept {
  const State end = order.profile.end(order.from);
  const double velocity = order.ending == Ending::cruise ? end.velocity : 0.0;
  return has_same_motion(end, {.velocity = velocity}, order.stop);
}

}  // namespace

void AxisRunner::wait(const MotionOrder& order) noexcept {
  if (waiting_) refuse(Outcome::replaced);
  waiting_ = order;
}

const MotionOrder* AxisRunner::due(Cycle cycle) const noexcept {
  return waiting_ && waiting_->begin <= cycle ? &*waiting_ : nullptr;
}

Outcome AxisRunner::objection(Cycle cycle) noexcept {
  if (waiting_->begin < cycle) return Outcome::too_late;
  if (report_.state == AxisState::unpowered) return Outcome::not_powered;
  if (report_.state == AxisState::stopping) return Outcome::is_stopping;
  if (!ends_as_it_says(*waiting_)) return Outcome::no_rest;
  return is_same(waiting_->from, commanded_at(cycle), waiting_->stop) ? Outcome::none
                                                                      : Outcome::other_start;
}

void AxisRunner::begin(Cycle cycle) noexcept {
  if (report_.state == AxisState::moving) end(Outcome::replaced);
  const MotionOrder& order = *waiting_;
  player_ = ProfilePlayer{order.profile, order.from, order.ending};
  began_ = cycle;
  stop_limits_ = order.stop;
  timeout_ = order.timeout;
  latest_stop_ = order.latest_stop;
  max_following_error_ = order.max_following_error;
  group_ = order.group;
  report_.running = order.id;
  report_.state = AxisState::moving;
  report_.stop = {};
  waiting_.reset();
}

void AxisRunner::refuse(Outcome why) noexcept {
  report_.ended = {.id = waiting_->id, .outcome = why};
  waiting_.reset();
}

StopCause AxisRunner::observe(Cycle cycle, const AxisInput& input, Cycle silence) noexcept {
  report_.actual = input.actual;
  report_.following_error = report_.commanded.position - input.actual.position;
  if (report_.state == AxisState::unpowered) {
    if (input.condition != AxisCondition::enabled) return StopCause::none;
    report_.commanded = {.position = input.actual.position};
    report_.following_error = 0.0;
    report_.state = AxisState::standing;
    return StopCause::none;
  }
  if (input.condition != AxisCondition::enabled) {
    if (report_.state == AxisState::moving) end(Outcome::stopped);
    report_.state = AxisState::unpowered;
    return cause_of(input.condition);
  }
  if (report_.state != AxisState::moving) return StopCause::none;
  if (std::abs(report_.following_error) > max_following_error_) return StopCause::following_error;
  if (silence > timeout_) return StopCause::sender_silent;
  if (cycle - began_ > latest_stop_) return StopCause::end_of_range;
  return StopCause::none;
}

void AxisRunner::stop(Cycle cycle, const Stop& stop) noexcept {
  if (waiting_) refuse(Outcome::stopped);
  report_.stop = stop;
  if (report_.state != AxisState::moving) return;
  end(Outcome::stopped);
  report_.state = AxisState::stopping;
  player_ = {stop_profile(report_.commanded, stop_limits_), report_.commanded, Ending::rest};
  began_ = cycle - 1;
}

const AxisReport& AxisRunner::run(Cycle cycle) noexcept {
  report_.cycles_left = 0;
  if (report_.state == AxisState::unpowered) {
    report_.commanded = {.position = report_.actual.position};
    report_.following_error = 0.0;
    return report_;
  }
  report_.commanded = commanded_at(cycle);
  if (report_.state == AxisState::standing) return report_;
  if (!player_.is_over()) {
    const double left = player_.duration() - static_cast<double>(cycle - began_) * period_;
    report_.cycles_left = static_cast<Cycle>(std::ceil(std::max(left, 0.0) / period_));
  } else if (player_.ending() == Ending::rest) {
    if (report_.state == AxisState::moving) end(Outcome::done);
    report_.state = AxisState::standing;
  }
  return report_;
}

State AxisRunner::commanded_at(Cycle cycle) noexcept {
  if (report_.state == AxisState::standing) return report_.commanded;
  return player_.at(static_cast<double>(cycle - began_) * period_);
}

void AxisRunner::end(Outcome outcome) noexcept {
  report_.ended = {.id = report_.running, .outcome = outcome};
  report_.running = 0;
}

}  // namespace takt::motion
