#include <algorithm>
#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/group/find_axes.hpp"
#include "apps/axis/not_ready.hpp"

namespace takt {
namespace {

using std::chrono::nanoseconds;

/// Longest wait for the answer of taktd to a motion.
constexpr std::chrono::seconds answer_time{2};
/// Longest wait for the event that gives the reason why a motion has ended.
constexpr std::chrono::milliseconds reason_time{100};
/// Number of cycles between two stop messages, until the axes are at rest.
constexpr std::int64_t cycles_between_stops = 4;
/// A motion begins at most this number of cycles after its command, or never.
constexpr std::int64_t longest_begin = 12;
/// Values of axis_motion_t::state and axis_motion_t::outcome.
constexpr std::int8_t motion_moves = 2;
constexpr std::int8_t motion_stops = 3;
constexpr std::int8_t outcome_done = 1;
constexpr std::int8_t outcome_stopped = 2;
constexpr std::int8_t outcome_refused = 4;

/// Returns the value for one axis: the value for this axis, the value for all axes, or 0.
double value_of(const Eigen::VectorXd& values, Eigen::Index axis) {
  if (values.size() == 0) return 0.0;
  return values(values.size() == 1 ? 0 : axis);
}

}  // namespace

/// The names of all axes, in the form in which taktd knows them.
std::vector<motion_goal_t> Axes::State::goals() const {
  std::vector<motion_goal_t> named;
  for (const Index axis : axes) {
    const signal_t& controlword = group.input().signals()[*group.axes().signals(axis).controlword];
    motion_goal_t goal{};
    goal.node = controlword.node;
    goal.axis = number_of_axis(controlword.index);
    named.push_back(std::move(goal));
  }
  return named;
}

std::vector<motion_goal_t> Axes::State::goals_within(const MotionBounds& bounds) const {
  std::vector<motion_goal_t> found = goals();
  for (Index i = 0; i < size(); ++i) {
    motion_goal_t& goal = found[static_cast<std::size_t>(i)];
    goal.max_velocity = value_of(bounds.velocity, i);
    goal.max_acceleration = value_of(bounds.acceleration, i);
    goal.max_jerk = value_of(bounds.jerk, i);
    goal.max_following_error = value_of(bounds.following_error, i);
  }
  return found;
}

Done Axes::State::wait_for_begin(const MotionBounds& bounds) {
  jog_goes_on_ = false;
  if (stream_ && stream_->begun && stream_goes_on()) {
    return obstacle(Obstacle::Kind::blocked, "the axes follow a stream: call wait() or stop()");
  }
  stream_.reset();
  for (const Eigen::VectorXd* bound :
       {&bounds.velocity, &bounds.acceleration, &bounds.jerk, &bounds.following_error}) {
    if (bound->size() <= 1 || bound->size() == size()) continue;
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format("expected one bound for each of {} axes, or one for all, got {} bounds", size(),
                    bound->size()));
  }
  if (!is_current()) return restarted();
  if (readiness_ == Readiness::not_enabled) return not_enabled();
  if (Done halted = check_halt(); !halted) return halted;
  if (!all_in_mode_of_motions()) {
    return obstacle(Obstacle::Kind::blocked,
                    "a motion needs cyclic synchronous position mode (8) on all axes: call "
                    "set_mode() first");
  }
  // taktd refuses a motion that was computed from the image of the newest stop or from an earlier
  // image.
  const auto newer =
      wait_until([this] { return group.input().cycle() > stop_cycle_; }, options.longest);
  if (!newer) return obstacle(Obstacle::Kind::time_over, "no image has come since the stop");
  if (!*newer) return *newer;
  if (!all_ready()) {
    const std::string fallback = event_text("fallback_begun");
    return obstacle(Obstacle::Kind::blocked,
                    why_not_ready_text() + (fallback.empty() ? "" : "; ") + fallback);
  }
  return {};
}

std::int32_t Axes::State::note_begin() {
  events_.clear();
  has_motion_ = true;
  motion_begin_ = last_sent_ = Clock::now();
  return ++id_;
}

Done Axes::State::begin(const std::string& kind, const Values& values, const MotionBounds& bounds) {
  jog_goes_on_ = false;
  if (values.size() != size()) {
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("expected one value for each of {} axes, got {} values", size(),
                                values.size()));
  }
  if (Done ready = wait_for_begin(bounds); !ready) return ready;
  motion_command_t command{};
  command.kind = kind;
  command.timeout_ms = static_cast<std::int32_t>(options.timeout.count());
  command.goals = goals_within(bounds);
  for (Index i = 0; i < size(); ++i) {
    motion_goal_t& goal = command.goals[static_cast<std::size_t>(i)];
    (kind == "jog" ? goal.velocity : goal.position) = values(i);
  }
  command.id = note_begin();
  jog_goes_on_ = kind == "jog";
  if (group.send_motion(command)) return {};
  return obstacle(Obstacle::Kind::no_bus, "LCM did not accept the command");
}

Done Axes::State::wait_for_answer() {
  const auto waited = wait_until([this] { return course() != Course::unanswered; }, answer_time);
  if (waited && !*waited) return *waited;
  if (course() == Course::runs) return {};
  return ended();
}

Done Axes::State::jog(const Values& velocities, const MotionBounds& bounds) {
  Done begun = begin("jog", velocities, bounds);
  if (begun) begun = wait_for_answer();
  if (begun && course() == Course::runs) return {};
  // An older motion may still run, so it is stopped.
  if (const Done stood = stop(); begun) begun = stood;
  return begun;
}

Done Axes::State::wait(nanoseconds longest) {
  if (profile_targets_ && !all_in_mode_of_motions()) return wait_for_profiles(longest);
  finish_stream();
  const auto waited = wait_until([this] { return !is_under_way(course()); }, longest);
  if (!waited) return obstacle(Obstacle::Kind::time_over, "the axes still move");
  stream_.reset();
  return *waited ? ended() : *waited;
}

bool Axes::State::is_under_way(Course course) const {
  const bool waits = course == Course::unanswered && Clock::now() - motion_begin_ < answer_time;
  return waits || course == Course::runs;
}

Axes::State::Course Axes::State::course_of(Index axis) const {
  const auto motion = group.motion(axis);
  if (!motion) return Course::unanswered;
  if (motion->id == id_) return Course::runs;
  if (motion->ended_id != id_) return Course::unanswered;
  if (motion->state == motion_stops) return Course::runs;
  if (motion->outcome == outcome_done) return Course::done;
  if (motion->outcome == outcome_stopped) return Course::stopped;
  return motion->outcome == outcome_refused ? Course::refused : Course::replaced;
}

/// Returns the state of the motion for all axes together. An axis without an answer takes
/// precedence over an axis that runs. A refusal counts while the motion is unanswered or runs,
/// because taktd may also refuse points of a running stream. It does not count when the motion is
/// over, because taktd then refuses copies of points.
Axes::State::Course Axes::State::course() const {
  if (!has_motion_) return Course::none;
  Course all_axes = Course::done;
  for (const Index axis : axes) {
    const Course one = course_of(axis);
    if (one == Course::unanswered) {
      all_axes = one;
      break;
    }
    const bool runs = one == Course::runs || all_axes == Course::runs;
    all_axes = runs ? Course::runs : std::max(all_axes, one);
  }
  if (all_axes != Course::unanswered && all_axes != Course::runs) return all_axes;
  const std::string refusal = fmt::format("motion {} of '{}'", id_, group.sender());
  return event_text("motion_refused", refusal).empty() ? all_axes : Course::refused;
}

/// Returns what the events and the drives report about the end of the newest motion.
std::string Axes::State::reason(Course course) const {
  const bool refused = course == Course::refused;
  std::string text = refused
                         ? event_text("motion_refused", fmt::format("motion {} ", id_))
                         : event_text("motion_stopped", fmt::format("motion {} has stopped", id_));
  if (text.empty()) text = event_text("command_refused", group.sender());
  if (!all_ready()) text += (text.empty() ? "" : "; ") + why_not_ready_text();
  return text;
}

Done Axes::State::ended() {
  const Course end = course();
  if (end == Course::none || end == Course::done) return {};
  const auto told = [&] { return !reason(end).empty(); };
  const auto waited = wait_until(told, reason_time, Interruption::ignored);
  if (waited && !*waited) return *waited;
  const std::string why = reason(end);
  switch (end) {
    case Course::refused:
      return obstacle(Obstacle::Kind::refused, why.empty() ? "taktd has refused the motion" : why);
    case Course::stopped:
      return obstacle(Obstacle::Kind::stopped, why.empty() ? "the motion has stopped" : why);
    case Course::replaced:
      return obstacle(Obstacle::Kind::stopped, "a newer motion has replaced this one");
    default:
      return obstacle(Obstacle::Kind::refused,
                      why.empty() ? "taktd has not answered the motion" : why);
  }
}

bool Axes::State::moving() const {
  return any([this](Index axis) {
    const auto motion = group.motion(axis);
    return motion && (motion->state == motion_moves || motion->state == motion_stops);
  });
}

void Axes::State::send_stop() {
  motion_command_t command{};
  command.kind = "stop";
  command.id = id_;
  command.timeout_ms = static_cast<std::int32_t>(options.timeout.count());
  command.goals = goals();
  stop_cycle_ = group.input().cycle();
  group.send_motion(command);
}

Done Axes::State::stop() {
  jog_goes_on_ = false;
  stream_.reset();
  if (sending_ == Sending::nothing) return {};
  if (!has_motion_ && !moving()) return stop_set_points();
  // taktd refuses a stop that was computed from an old image, so the waiting messages are read
  // first.
  const Done heard = step(Interruption::ignored);
  if (!is_current()) return heard;
  return stop_now();
}

Done Axes::State::stop_now() {
  send_stop();
  const std::int64_t begin = stop_cycle_;
  const auto stands = [&] {
    const std::int64_t cycle = group.input().cycle();
    if (cycle - stop_cycle_ >= cycles_between_stops) send_stop();
    return cycle - begin > longest_begin && !moving();
  };
  const auto waited = wait_until(stands, options.longest, Interruption::ignored);
  if (waited && !*waited) return *waited;
  if (!waited) return obstacle(Obstacle::Kind::time_over, "the axes still move");
  has_motion_ = false;
  return {};
}

}  // namespace takt
