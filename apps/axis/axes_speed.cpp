#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"

// The calls of Axes for speed axes. This program computes the control words and set speeds of the
// axes from each image. taktd stops the axes when this program is silent.

namespace takt {
namespace {

using std::chrono::nanoseconds;

/// Number of cycles for which the last control words are sent before release().
constexpr std::int64_t cycles_before_release = 3;

double acceleration_of(const MotionBounds& bounds, Eigen::Index axis) {
  const Eigen::VectorXd& all = bounds.acceleration;
  return all.size() == 0 ? 0.0 : all(all.size() == 1 ? 0 : axis);
}

}  // namespace

/// Finds the speed axes of these names, or all of them. Returns false if there are none.
bool Axes::State::find_speed_axes() {
  std::vector<SpeedAxis> found;
  const auto is_usable = [&](const speed_axis_t& words) {
    return SpeedAxis::is_usable(words, group.input());
  };
  const std::vector<speed_axis_t>& known = group.speed_axes();
  for (const speed_axis_t& words : known) {
    if (options.names.empty() && is_usable(words)) found.emplace_back(words);
  }
  for (const std::string& name : options.names) {
    const auto words = std::ranges::find(known, name, &speed_axis_t::node);
    const bool twice = std::ranges::count(options.names, name) > 1;
    if (words == known.end() || twice || !is_usable(*words)) return false;
    found.emplace_back(*words);
  }
  if (found.empty()) return false;
  for (const SpeedAxis& axis : found) {
    names.push_back(axis.words().node);
    units.push_back(axis.words().unit);
  }
  speed.emplace(std::move(found));
  const auto cycles = options.timeout / std::max<nanoseconds>(group.period(), nanoseconds{1});
  group.set_time_to_live(static_cast<std::int32_t>(std::clamp<std::int64_t>(cycles, 3, 1'000'000)));
  return true;
}

/// Ends the run after a stop that was not requested: the drives must not run again without a
/// command when the cause of the stop is gone. All axes of the run stop.
void Axes::State::end_stopped_run() {
  if (!speed->any_wants_to_run()) return;
  stopped_text_ = why_speed_ended();
  if (!stopped_text_.empty()) speed->end_run();
}

/// Sends the control words and set speeds that follow from the newest image. A program that was
/// silent for longer than its timeout must not make the drives run again by itself.
void Axes::State::send_speeds() {
  const auto now = Clock::now();
  const bool was_silent = sending_ != Sending::nothing && now - last_sent_ > options.timeout;
  if (was_silent && speed->moving()) {
    stopped_text_ = fmt::format("this program was silent for {} ms, so the drives were stopped",
                                (now - last_sent_) / std::chrono::milliseconds{1});
    speed->end_run();
  }
  end_stopped_run();
  speed->read(group.input());
  end_stopped_run();
  speed->step(group.input());
  if (sending_ == Sending::nothing) return;
  last_sent_ = now;
  command_t command = speed->command();
  group.send_values(command);
}

/// Returns what has ended the newest run, or an empty text.
std::string Axes::State::why_speed_ended() const {
  if (!stopped_text_.empty()) return stopped_text_;
  for (const event_t& event : events_) {
    if (event.kind == "fallback_begun" && speed->has_node(event.node_id)) return event.text;
  }
  const bool held = speed->any([&](const SpeedAxis& axis) {
    return group.holder_of_node(axis.words().node_id).is_other(held_statuses);
  });
  return speed->all_ready() && !held ? "" : speed->why_not_ready(group);
}

Done Axes::State::enable_speed() {
  if (!is_current()) return restarted();
  events_.clear();
  stopped_text_.clear();
  speed->set_goal(SpeedGoal::standing);
  sending_ = Sending::controls;
  last_sent_ = Clock::now();
  const auto held = [&](auto is) {
    for (Index i = 0; i < size(); ++i) {
      if (is(group.holder_of_node(speed->at(i).words().node_id))) return true;
    }
    return false;
  };
  const auto by_other = [](const NodeHolder& holder) { return holder.is_other(held_statuses); };
  const auto not_by_this = [](const NodeHolder& holder) { return !holder.own; };
  const auto ready = [&] { return speed->all_ready() && !held(not_by_this); };
  const auto waited = wait_until([&] { return ready() || speed->any_in_fault() || held(by_other); },
                                 options.longest);
  if (waited && !*waited) return *waited;
  if (ready()) return {};
  const std::string why = speed->why_not_ready(group);
  [[maybe_unused]] const Done done = disable_speed();  // only the first obstacle is reported
  return obstacle(Obstacle::Kind::blocked, why);
}

Done Axes::State::disable_speed() {
  if (!is_current()) return {};
  if (!std::exchange(held_, {}).empty() && sending_ == Sending::nothing) group.release();
  if (sending_ == Sending::nothing) return {};
  const Done stood = stop_speed();
  if (!is_current()) return stood;
  speed->set_goal(SpeedGoal::off);
  const std::int64_t begin = group.input().cycle();
  const auto waited =
      wait_until([&] { return group.input().cycle() - begin > cycles_before_release; },
                 options.longest, Interruption::ignored);
  sending_ = Sending::nothing;
  group.release();
  return waited && !*waited ? *waited : stood;
}

Done Axes::State::reset_speed() {
  if (!is_current()) return restarted();
  if (!speed->any_in_fault()) return {};
  for (Index i = 0; i < size(); ++i) {
    if (speed->at(i).state() == SpeedState::fault) speed->at(i).reset_fault();
  }
  if (sending_ == Sending::nothing) last_sent_ = Clock::now();
  sending_ = Sending::controls;
  const auto waited = wait_until([&] { return !speed->any_in_fault(); }, options.longest);
  if (waited) return *waited;
  return obstacle(Obstacle::Kind::blocked, speed->why_not_ready(group));
}

Done Axes::State::check_speeds(const Values& velocities, const MotionBounds& bounds) const {
  if (velocities.size() != size() ||
      (bounds.acceleration.size() > 1 && bounds.acceleration.size() != size())) {
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format("{} velocities and {} accelerations for {} axes: expected one velocity for "
                    "each axis, and one acceleration for each axis, one for all axes, or none",
                    velocities.size(), bounds.acceleration.size(), size()));
  }
  for (Index i = 0; i < size(); ++i) {
    const speed_axis_t& words = speed->at(i).words();
    if (!speed->at(i).can_hold(velocities(i), group.input())) {
      return obstacle(Obstacle::Kind::wrong_use,
                      fmt::format("{} can't be commanded to run at {} {}", words.node,
                                  velocities(i), words.unit));
    }
    if (words.max_speed > 0.0 && std::abs(velocities(i)) > words.max_speed) {
      return obstacle(Obstacle::Kind::refused,
                      fmt::format("{} {} is above the limit of {}, {} {}", velocities(i),
                                  words.unit, words.node, words.max_speed, words.unit));
    }
    const double acceleration = acceleration_of(bounds, i);
    if (words.max_acceleration > 0.0 && acceleration > words.max_acceleration) {
      return obstacle(
          Obstacle::Kind::refused,
          fmt::format("an acceleration of {} {}/s is above the limit of {}, {} {}/s", acceleration,
                      words.unit, words.node, words.max_acceleration, words.unit));
    }
  }
  return {};
}

/// If the new run fails, an older run does not continue.
Done Axes::State::run_speed(const Values& velocities, const MotionBounds& bounds) {
  Done done = begin_run(velocities, bounds);
  // Only the first obstacle is reported.
  if (!done && is_current()) [[maybe_unused]]
    const Done stood = stop_speed();
  return done;
}

Done Axes::State::begin_run(const Values& velocities, const MotionBounds& bounds) {
  if (Done fits = check_speeds(velocities, bounds); !fits) return fits;
  if (!is_current()) return restarted();
  if (sending_ == Sending::nothing) {
    return obstacle(Obstacle::Kind::blocked, "the axes are not enabled: call enable() first");
  }
  events_.clear();
  stopped_text_.clear();
  // The waiting messages are read first. After a long silence of this program, they report that the
  // drives were stopped.
  if (const Done heard = step(Interruption::obeyed); !heard) return heard;
  if (const std::string why = why_speed_ended(); !why.empty()) {
    return obstacle(Obstacle::Kind::blocked, why);
  }
  speed->run(velocities, bounds.acceleration);
  const auto begun = [&] { return speed->all_run() || !why_speed_ended().empty(); };
  const auto waited = wait_until(begun, options.longest);
  if (waited && *waited && speed->all_run()) return {};
  if (waited && !*waited) return *waited;
  const std::string why = why_speed_ended();
  return obstacle(Obstacle::Kind::blocked, why.empty() ? "the drives do not begin to run" : why);
}

/// This wait ends only when the drives no longer run.
Done Axes::State::wait_speed(nanoseconds longest) {
  const auto over = [&] { return !speed->moving() || !why_speed_ended().empty(); };
  const auto waited = wait_until(over, longest);
  if (!waited) return obstacle(Obstacle::Kind::time_over, "the axes still run");
  if (!*waited) return *waited;
  const std::string why = why_speed_ended();
  if (why.empty()) return {};
  return obstacle(Obstacle::Kind::stopped, why);
}

Done Axes::State::stop_speed() {
  if (sending_ == Sending::nothing) return {};
  speed->stop();
  const auto stands = [&] { return speed->all_stand() || speed->any_in_fault(); };
  const auto waited = wait_until(stands, options.longest, Interruption::ignored);
  if (waited && !*waited) return *waited;
  if (waited) return {};
  return obstacle(Obstacle::Kind::time_over, "the drives have not come to standstill");
}

Done Axes::State::no_drive() const {
  return obstacle(Obstacle::Kind::wrong_use,
                  fmt::format("{} is a speed axis: use jog() and stop()", names.front()));
}

Done Axes::State::no_position() const {
  return obstacle(Obstacle::Kind::wrong_use,
                  fmt::format("{} is a speed axis and has no position: use jog()", names.front()));
}

}  // namespace takt
