#include "master/motion/beat/axis_runner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "master/motion/beat/stop_profile.hpp"
#include "master/motion/enough_jerk.hpp"
#include "master/motion/position_range.hpp"

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
    case AxisCondition::halted:
      return StopCause::halted;
    case AxisCondition::silent:
      return StopCause::no_statusword;
    case AxisCondition::unsent:
      return StopCause::not_sent;
    case AxisCondition::inactive:
      return StopCause::inactive;
  }
  return StopCause::none;
}

/// Returns true if the drive follows set-points, or possibly does.
bool may_follow(AxisCondition condition) noexcept {
  return condition == AxisCondition::enabled || condition == AxisCondition::halted ||
         condition == AxisCondition::silent || condition == AxisCondition::unsent;
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

/// Returns true if the profile ends as `ending` says. There is nothing to check for a stream, which
/// ends with points that are not known yet, and for a gear, which ends with a stop.
bool ends_as_it_says(const MotionOrder& order) noexcept {
  if (order.ending == Ending::points || order.ending == Ending::gear) return true;
  const State end = order.profile.end(order.from);
  const double velocity = order.ending == Ending::cruise ? end.velocity : 0.0;
  return has_same_motion(end, {.velocity = velocity}, order.stop);
}

}  // namespace

Outcome AxisRunner::wait(const MotionOrder& order) noexcept {
  if (!is_sound(order)) return Outcome::unsound;
  if (has_taken_) return Outcome::second_in_cycle;
  if (order.ending == Ending::points && is_streaming()) return Outcome::is_stopping;
  has_taken_ = true;
  if (waiting_) refuse(Outcome::replaced);
  waiting_ = order;
  if (order.ending == Ending::points) stream_.begin(order.id, order.from);
  return Outcome::none;
}

void AxisRunner::add_points(const StreamPoints& points) noexcept {
  if (stream_.order() != points.order) return;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!stream_.add(points.points[i])) return;
  }
}

const MotionOrder* AxisRunner::due(CycleNumber cycle) const noexcept {
  return waiting_ && waiting_->begin <= cycle ? &*waiting_ : nullptr;
}

Outcome AxisRunner::objection(CycleNumber cycle) noexcept {
  if (waiting_->begin < cycle) return Outcome::too_late;
  if (report_.state == AxisState::unpowered || !follows_) return Outcome::not_powered;
  if (report_.state == AxisState::stopping) return Outcome::is_stopping;
  const bool is_stream = waiting_->ending == Ending::points;
  if (is_stream && report_.state != AxisState::standing) return Outcome::is_stopping;
  if (waiting_->ending == Ending::gear)
    return can_stop_with(*waiting_) ? Outcome::none : Outcome::no_stop;
  if (!ends_as_it_says(*waiting_)) return Outcome::no_rest;
  return is_same(waiting_->from, commanded_at(cycle), waiting_->stop) ? Outcome::none
                                                                      : Outcome::other_start;
}

void AxisRunner::begin(CycleNumber cycle) noexcept {
  if (report_.state == AxisState::moving) end(Outcome::replaced);
  const MotionOrder& order = *waiting_;
  const Limits limits = order.ending == Ending::gear ? limits_of_gear(order) : order.stop;
  source_ = source_of(order.ending);
  if (source_ == Source::gear) {
    gear_.begin(order.gear, limits);
    range_ = widened(order.gear.range, report_.commanded.position);
  }
  player_ = ProfilePlayer{order.profile, order.from, order.ending};
  report_.began = cycle;
  stop_limits_ = limits;
  timeout_ = order.timeout;
  latest_stop_ = order.latest_stop;
  max_following_error_ = order.max_following_error;
  group_ = order.group;
  sender_ = order.sender;
  newest_ = order.id;
  report_.running = order.id;
  report_.state = AxisState::moving;
  report_.stop = {};
  waiting_.reset();
}

void AxisRunner::refuse(Outcome why) noexcept {
  end(waiting_->id, why);
  waiting_.reset();
}

/// Notes how much time has passed since the last set-point. From one set-point to the next, a
/// motion never advances by more than one period: a missing beat delays the motion by a period.
void AxisRunner::wait_for_drive(CycleNumber cycle, bool is_unsent) noexcept {
  const bool runs = report_.state == AxisState::moving || report_.state == AxisState::stopping;
  is_unsent_ = is_unsent;
  passed_ = cycle - last_run_;
  report_.delay = runs ? passed_ - (is_unsent ? 0U : 1U) : 0U;
  report_.began += report_.delay;
  last_run_ = cycle - 1;
}

StopCause AxisRunner::observe(CycleNumber cycle, const AxisInput& input,
                              const Silence& silence) noexcept {
  wait_for_drive(cycle, input.is_unsent);
  const bool followed = std::exchange(follows_, input.condition == AxisCondition::enabled);
  report_.homing = input.homing;
  report_.actual = input.actual;
  report_.following_error = report_.commanded.position - input.actual.position;
  if (report_.state == AxisState::unpowered) {
    report_.kept_alive = false;
    if (input.condition != AxisCondition::enabled) return StopCause::none;
    report_.commanded = {.position = input.set_point.value_or(input.actual.position)};
    report_.following_error = 0.0;
    report_.state = AxisState::standing;
    return StopCause::none;
  }
  if (!may_follow(input.condition)) {
    if (report_.state == AxisState::moving) end(Outcome::stopped);
    report_.state = AxisState::unpowered;
    report_.kept_alive = false;
    return cause_of(input.condition);
  }
  report_.kept_alive =
      newest_ != 0 && (report_.state != AxisState::standing || silence.sender <= timeout_);
  if (report_.state == AxisState::standing && input.set_point) {
    report_.commanded = {.position = *input.set_point};
  }
  if (input.condition == AxisCondition::unsent && report_.state != AxisState::standing) {
    abandon({.cause = StopCause::not_sent, .axis = axis_});
  }
  if (followed && !follows_) return cause_of(input.condition);
  return report_.state == AxisState::moving ? cause_of_motion(cycle, silence) : StopCause::none;
}

StopCause AxisRunner::cause_of_motion(CycleNumber cycle, const Silence& silence) const noexcept {
  if (std::abs(report_.following_error) > max_following_error_) return StopCause::following_error;
  const bool is_jog = source_ == Source::profile && player_.ending() == Ending::cruise;
  if (sender_ == no_sender) return StopCause::sender_left;
  if ((is_jog ? silence.jog : silence.sender) > timeout_) return StopCause::sender_silent;
  if (source_ == Source::points && time_at(cycle) > stream_.last().time && !points_end_at_rest()) {
    return StopCause::points_ended;
  }
  if (cycle - report_.began > latest_stop_) return StopCause::end_of_range;
  return StopCause::none;
}

/// Notes a stop in the report, and ends an order that waits. If an order waits while nothing moves,
/// a stop that is already in the report belongs to an older motion and is replaced.
void AxisRunner::note(const Stop& stop) noexcept {
  const bool runs = report_.state == AxisState::moving || report_.state == AxisState::stopping;
  const bool is_first = report_.stop.cause == StopCause::none || (waiting_ && !runs);
  if (waiting_) refuse(Outcome::stopped);
  if (is_first) report_.stop = stop;
}

void AxisRunner::stop(const Stop& stop) noexcept {
  note(stop);
  if (report_.state != AxisState::moving) return;
  end(Outcome::stopped);
  report_.state = AxisState::stopping;
  source_ = Source::profile;
  player_ = {stop_profile(report_.commanded, stop_limits_), report_.commanded, Ending::rest};
  report_.began = last_run_ + (is_unsent_ ? 1U : 0U);
}

void AxisRunner::abandon(const Stop& stop) noexcept {
  const bool runs = report_.state == AxisState::moving || report_.state == AxisState::stopping;
  if (runs || waiting_) note(stop);
  if (!runs) return;
  if (report_.state == AxisState::moving) end(Outcome::stopped);
  report_.state = AxisState::standing;
  report_.commanded = {.position = report_.commanded.position};
}

void AxisRunner::leave_group() noexcept {
  newest_ = 0;
  group_ = axis_;
  report_.kept_alive = false;
}

/// Returns true if a stop that begins in this state stays inside the range of the gear. If the ends
/// of the range are far away, an upper bound of the stopping distance is enough.
bool AxisRunner::can_stop_from(const State& state) const noexcept {
  const Limits& limits = stop_limits_;
  const double least = std::min(limits.max_acceleration, -limits.min_acceleration);
  const double most = std::max(limits.max_acceleration, -limits.min_acceleration);
  const double acceleration = std::abs(state.acceleration);
  const double speed = std::abs(state.velocity) + acceleration * acceleration / (2 * limits.jerk);
  const double reach = speed * (speed / least + (acceleration + most) / limits.jerk);
  if (state.position - reach >= range_.min && state.position + reach <= range_.max) return true;
  return stays_inside(range_, stop_profile(state, limits), state);
}

/// Returns the limits of a gear. Only the bus thread knows the state of an axis that moves, so the
/// jerk of the gear is determined here.
Limits AxisRunner::limits_of_gear(const MotionOrder& gear) const noexcept {
  if (report_.state != AxisState::moving) return gear.stop;
  return with_enough_jerk(gear.stop, report_.commanded, stop_limits_);
}

/// Returns true if the axis can stop with the limits of this gear. A gear replaces the limits of
/// the previous motion, so it may only begin if a stop along its own limits stays inside its range
/// and takes a bounded time.
bool AxisRunner::can_stop_with(const MotionOrder& gear) const noexcept {
  const State& state = report_.commanded;
  const Profile profile = stop_profile(state, limits_of_gear(gear));
  return profile.duration() <= longest_stop &&
         stays_inside(widened(gear.gear.range, state.position), profile, state);
}

LeaderSignals AxisRunner::leader_signals(CycleNumber cycle) const noexcept {
  const auto signal_of = [](const GearTask& task) {
    return task.kind == LeaderKind::measured ? std::optional{task.signal} : std::nullopt;
  };
  LeaderSignals signals;
  if (has_gear()) signals[0] = signal_of(gear());
  const MotionOrder* next = due(cycle);
  if (next != nullptr && next->ending == Ending::gear) signals[1] = signal_of(next->gear);
  return signals;
}

StopCause AxisRunner::follow(const LeaderState& leader, const LeaderSample& sample) noexcept {
  geared_ = gear_.step(report_.commanded, leader, sample, static_cast<double>(passed_) * period_,
                       period_);
  if (is_unsent_) geared_ = report_.commanded;
  StopCause cause = StopCause::none;
  if (gear_.has_lost_leader()) {
    cause = StopCause::leader_lost;
  } else if (gear_.is_off()) {
    cause = StopCause::phase_error;
  } else if (gear_.is_forgotten()) {
    cause = StopCause::application;
  } else if (!can_stop_from(geared_)) {
    cause = StopCause::end_of_range;
  }
  if (cause != StopCause::none) stop({.cause = cause, .axis = axis_});
  return cause;
}

const AxisReport& AxisRunner::run(CycleNumber cycle) noexcept {
  has_taken_ = false;
  report_.cycles_left = 0;
  report_.gear = has_gear() ? gear_.phase() : GearPhase::none;
  report_.phase_error = has_gear() ? gear_.phase_error() : 0.0;
  if (report_.state == AxisState::unpowered) {
    last_run_ = cycle;
    report_.commanded = {.position = report_.actual.position};
    report_.following_error = 0.0;
    return report_;
  }
  report_.commanded = has_gear() ? geared_ : commanded_at(cycle);
  last_run_ = cycle;
  if (report_.state == AxisState::standing || has_gear()) return report_;
  end_or_count_down(cycle);
  return report_;
}

void AxisRunner::end_or_count_down(CycleNumber cycle) noexcept {
  const bool streams = source_ == Source::points;
  const double left = (streams ? stream_.last().time : player_.duration()) - time_at(cycle);
  if (streams ? left > 0.0 : !player_.is_over()) {
    constexpr double most = 1e15;
    constexpr double rounding = 1e-6;  // cycles
    const double cycles = std::ceil(left / period_ - rounding);
    report_.cycles_left = static_cast<CycleNumber>(std::clamp(cycles, 0.0, most));
  } else if (streams ? points_end_at_rest() : player_.ending() == Ending::rest) {
    if (report_.state == AxisState::moving) end(Outcome::done);
    report_.state = AxisState::standing;
    report_.commanded = {.position = report_.commanded.position};
  }
}

/// Returns true if the stream ends at rest. The acceleration at the end of a cubic curve follows
/// from the other values of the curve. The acceleration of the axis may jump from this value to 0,
/// as it may jump to the first acceleration of a next curve.
bool AxisRunner::points_end_at_rest() const noexcept {
  const StreamPoint& last = stream_.last();
  State end = last.state;
  if (last.curve == Curve::cubic) end.acceleration = 0.0;
  return has_same_motion(end, {}, stop_limits_);
}

State AxisRunner::commanded_at(CycleNumber cycle) noexcept {
  if (report_.state == AxisState::standing) return report_.commanded;
  if (source_ == Source::gear) {
    if (is_unsent_) return report_.commanded;
    return gear_.released(report_.commanded, static_cast<double>(cycle - last_run_) * period_);
  }
  return source_ == Source::points ? stream_.at(time_at(cycle)) : player_.at(time_at(cycle));
}

void AxisRunner::end(Outcome outcome) noexcept {
  end(report_.running, outcome);
  report_.running = 0;
}

}  // namespace takt::motion
