#include "apps/takt/simulate/program/motion_commander.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time message_period = 20ms;
constexpr Time message_jitter = 10ms;
constexpr Time busy_pause = 800ms;  // longest pause between two motions
constexpr Time calm_pause = 2s;     // minimum; a motion comes to rest in this pause
constexpr double quick = 20'000;    // counts/s; for axes whose limit is not lower
constexpr double quick_rise = 0.1;  // s until the velocity is reached
constexpr double jerk_rise = 0.05;  // s until the acceleration is reached
constexpr double reach_time = 3.0;  // duration in s of a quick motion to the farthest target
constexpr double part_of_range = 0.5;
constexpr double near = 0.1;  // part of the reach within which most targets are
constexpr Time longest_path = 8s;
constexpr Time rest_time = 200ms;       // without a change of the target position
constexpr Time longest_wait = 4s;       // for an axis to come to rest before its stream
constexpr double part_of_leader = 0.6;  // part of the limits of the follower
constexpr Time time_to_lock = 1s;       // from the command of a gear to the motion of its leader
constexpr Time time_to_lead = 3s;       // from this motion to the next one
// The distance of a gear to its phase, as the time in which the axis moves as far at its velocity.
constexpr double seconds_of_catch_up = 0.05;
constexpr unsigned rival = 7;
constexpr std::array<std::int32_t, 6> timeouts{0, 0, 100, 200, 1000, 3000};  // ms

/// Fills in the fields that all messages about motions have.
template <class Message>
void fill_from(const motion_command_t& command, Message& message) {
  message.utime = command.utime;
  message.schema = command.schema;
  message.session = command.session;
  message.instance = command.instance;
  message.sender = command.sender;
  message.cycle = command.cycle;
  message.id = command.id;
  message.timeout_ms = command.timeout_ms;
  message.goals = command.goals;
  message.num_goals = command.num_goals;
}

}  // namespace

MotionCommander::MotionCommander(const BusPlan& plan, const std::vector<bool>& nodes,
                                 unsigned number)
    : number_{number} {
  for (const MotionAxis& axis : motion_axes(plan)) {
    if (nodes[axis.node_index]) axes_.push_back(axis_of(plan, axis));
    leaders_.push_back({.node = plan.nodes[axis.node_index].name,
                        .number = axis.number,
                        .position = plan.layout.signals[axis.position].name});
  }
}

MotionCommander::Axis MotionCommander::axis_of(const BusPlan& plan, const MotionAxis& signals) {
  const Signal& target = plan.layout.signals[signals.target];
  Axis axis{.signals = signals,
            .node = plan.nodes[signals.node_index].name,
            .scale = target.scale,
            .offset = target.offset,
            .speed = quick,
            .acceleration = quick / quick_rise,
            .reach = 1e9};
  const double counts = 1.0 / std::abs(target.scale);
  bool has_velocity = false;
  bool has_acceleration = false;
  for (const LimitLine& line : plan.limits.lines) {
    const bool mine = line.node_index == signals.node_index && line.axis == signals.number + 1;
    if (!mine || !line.high) continue;
    const double half = *line.high * counts / 2;
    if (line.kind == LimitKind::position) axis.reach = half * 2 * part_of_range;
    if (line.kind == LimitKind::velocity) axis.speed = std::min(axis.speed, half);
    if (line.kind == LimitKind::acceleration) {
      axis.acceleration = std::min(axis.acceleration, half);
    }
    has_velocity |= line.kind == LimitKind::velocity;
    has_acceleration |= line.kind == LimitKind::acceleration;
  }
  axis.limited = has_velocity && has_acceleration;
  axis.reach = std::min(axis.reach, reach_time * axis.speed);
  return axis;
}

bool MotionCommander::leads(SignalIndex output) const noexcept {
  return std::ranges::any_of(axes_, [&](const Axis& axis) {
    return axis.signals.target == output || axis.signals.velocity_offset == output;
  });
}

void MotionCommander::start(sim::Random random) {
  random_ = random;
  due_ = motion_due_ = {};
  leaves_ = false;
  calm_ = random_.chance(0.4);
  timeout_ms_ = timeouts[random_.below(timeouts.size())];
  for (Axis& axis : axes_) axis.pace = share(0.2);
  gear_random_ = random.fork(1);
  gears_ = gear_random_.chance(0.4);
  streams_ = gear_random_.chance(0.4);
  path_ = {};
  leading_.reset();
  streaming_.reset();
}

void MotionCommander::see(SignalIndex target, std::int64_t counts, Time now) noexcept {
  for (Axis& axis : axes_) {
    if (axis.signals.target != target) continue;
    const auto position = static_cast<double>(counts);
    if (position != axis.position) axis.moved = now;
    axis.position = position;
  }
}

/// The targets of a rival are farther away than those of any other program, so that its axes come
/// to rest at such a target only if the rival has moved them.
std::int64_t MotionCommander::target_of(const Axis& axis) {
  const double sign = random_.chance(0.5) ? 1 : -1;
  double counts = sign * share(0) * axis.reach;
  if (number_ == rival) {
    counts = sign * (1.2 + share(0) * 0.3) * axis.reach;
  } else if (random_.chance(0.7)) {
    counts = std::clamp(axis.position + counts * near, -axis.reach, axis.reach);
  }
  return (std::llround(counts) & ~std::int64_t{15}) | number_;
}

motion_goal_t MotionCommander::goal_of(const Axis& axis) {
  const std::int64_t counts = target_of(axis);
  const double pace = random_.chance(0.2) ? share(0.2) : axis.pace;
  const bool of_file = axis.limited && random_.chance(0.1);
  motion_goal_t goal{};
  goal.node = axis.node;
  goal.axis = static_cast<std::int8_t>(axis.signals.number == 0 ? 0 : axis.signals.number + 1);
  goal.position = static_cast<double>(counts) * axis.scale + axis.offset;
  if (of_file) return goal;
  const double size = std::abs(axis.scale);
  goal.max_velocity = pace * axis.speed * size;
  goal.max_acceleration = pace * axis.acceleration * size;
  if (random_.chance(0.8)) goal.max_jerk = goal.max_acceleration / jerk_rise;
  goal.velocity = (random_.chance(0.5) ? 1 : -1) * share(0.1) * goal.max_velocity;
  if (random_.chance(0.1)) goal.max_following_error = 1 + random_.below(2000) * size;
  return goal;
}

void MotionCommander::add_goals(motion_command_t& command, bool all) {
  const std::uint32_t one = random_.below(static_cast<std::uint32_t>(axes_.size()));
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (all || i == one) command.goals.push_back(goal_of(axes_[i]));
  }
}

motion_command_t MotionCommander::motion() {
  motion_command_t command{};
  command.id = ++id_;
  const std::uint32_t choice = random_.below(20);
  command.kind = choice < 15 ? "move" : choice < 18 ? "jog" : "stop";
  constexpr std::array<const char*, 6> synchronisations{"",     "time", "phase",
                                                        "none", "none", "none"};
  command.synchronisation = synchronisations[random_.below(synchronisations.size())];
  add_goals(command, random_.chance(0.5));
  return command;
}

/// Lets an axis follow a leader; both are chosen at random. Returns nothing if both are the same
/// axis.
std::optional<motion_command_t> MotionCommander::choose_gear() {
  const Axis& axis = axes_[gear_random_.below(static_cast<std::uint32_t>(axes_.size()))];
  const Leader& leader = leaders_[gear_random_.below(static_cast<std::uint32_t>(leaders_.size()))];
  if (leader.node == axis.node && leader.number == axis.signals.number) return std::nullopt;
  motion_command_t command{};
  command.id = ++id_;
  command.kind = "gear";
  command.goals.push_back(goal_of(axis));
  const auto ratio = static_cast<double>(gear_random_.below(1501)) / 1000;
  gear_ = {};
  gear_.leader = leader.node;
  gear_.leader_axis = static_cast<std::int8_t>(leader.number + 1);
  if (gear_random_.chance(0.4)) gear_.signal = leader.position;
  gear_.phase = gear_random_.chance(0.5) ? "at" : "here";
  gear_.numerator = {gear_random_.chance(0.5) ? ratio : -ratio};
  gear_.denominator = {1.0};
  gear_.max_phase_error = {gear_random_.chance(0.2) ? std::abs(axis.scale) * 1000 : 0.0};
  if (gear_random_.chance(0.7)) plan_leading(command.goals.front(), axis);
  return command;
}

/// Plans a motion of the leader that is so slow that the axis can follow it within its limits. The
/// phase becomes one near the present difference, so that the axis is locked before its leader
/// moves. If this program does not command the leader, no motion is planned.
void MotionCommander::plan_leading(motion_goal_t& follower, const Axis& axis) {
  const double ratio = gear_.numerator.front();
  const auto leader = std::ranges::find_if(axes_, [&](const Axis& other) {
    return other.node == gear_.leader && other.signals.number + 1 == gear_.leader_axis;
  });
  if (leader == axes_.end() || follower.max_velocity == 0 || ratio == 0) return;
  motion_goal_t goal = goal_of(*leader);
  if (goal.max_velocity == 0) return;
  const double jerk =
      follower.max_jerk == 0 ? follower.max_acceleration / jerk_rise : follower.max_jerk;
  const double part = part_of_leader / std::abs(ratio);
  goal.max_velocity = std::min(goal.max_velocity, part * follower.max_velocity);
  goal.max_acceleration = std::min(goal.max_acceleration, part * follower.max_acceleration);
  goal.max_jerk = std::min(goal.max_acceleration / jerk_rise, part * jerk);
  leading_ = goal;
  const double way = (2 * share(0) - 1) * seconds_of_catch_up * follower.max_velocity;
  follower.position = axis.place() - ratio * leader->place() + way;
}

motion_command_t MotionCommander::lead() {
  motion_command_t command{};
  command.id = ++id_;
  command.kind = "move";
  command.synchronisation = "none";
  command.goals.push_back(*std::exchange(leading_, std::nullopt));
  return command;
}

motion_gear_t MotionCommander::gear(const motion_command_t& command) const {
  motion_gear_t gear = gear_;
  fill_from(command, gear);
  return gear;
}

/// Chooses an axis for a stream. Most streams begin when their axis has come to rest. The others
/// begin with the next message; takt refuses them if the axis moves.
void MotionCommander::choose_stream(Time now) {
  const std::size_t axis = gear_random_.below(static_cast<std::uint32_t>(axes_.size()));
  streaming_ = Streaming{.axis = axis, .until = now};
  if (gear_random_.chance(0.8)) streaming_->until += longest_wait;
}

/// Returns nothing if the path would take too long, or if the motion has only the limits of the
/// network file.
std::optional<motion_command_t> MotionCommander::begin_stream(const Axis& axis, Time now) {
  motion_goal_t goal = goal_of(axis);
  if (goal.max_velocity == 0) return std::nullopt;
  if (goal.max_jerk == 0) goal.max_jerk = goal.max_acceleration / jerk_rise;
  const StreamPath path{
      axis.place(),
      goal.position,
      {.velocity = goal.max_velocity, .acceleration = goal.max_acceleration, .jerk = goal.max_jerk},
      now};
  if (path.duration() > longest_path) return std::nullopt;
  path_ = path;
  path_goal_ = goal;
  ++id_;
  motion_due_ += path.duration();
  return next_points(now);
}

motion_command_t MotionCommander::next_points(Time now) {
  stream_ = {};
  path_.put_points(stream_, now);
  motion_command_t command{};
  command.id = id_;
  command.kind = stream_.first_point == 0 && stream_.num_points > 0 ? "stream" : "points";
  command.goals.push_back(path_goal_);
  return command;
}

motion_stream_t MotionCommander::stream(const motion_command_t& command) const {
  motion_stream_t stream = stream_;
  fill_from(command, stream);
  return stream;
}

motion_command_t MotionCommander::stop_all() const {
  motion_command_t command{};
  command.kind = "stop";
  for (const Axis& axis : axes_) {
    motion_goal_t goal{};
    goal.node = axis.node;
    goal.axis = static_cast<std::int8_t>(axis.signals.number + 1);
    command.goals.push_back(goal);
  }
  return command;
}

/// Returns the time from the begin of a motion to the next one.
Time MotionCommander::pause() {
  return calm_ ? calm_pause + random_.up_to(calm_pause) : random_.up_to(busy_pause);
}

std::optional<motion_command_t> MotionCommander::next(Time now) {
  if (axes_.empty() || now < due_) return std::nullopt;
  due_ = now + message_period + random_.up_to(message_jitter);
  if (random_.chance(0.01)) due_ += random_.chance(0.1) ? Time{2s} : Time{300ms};
  motion_command_t command{};
  command.kind = "alive";
  if (leaves_) {
    command = stop_all();
  } else if (!path_.is_over()) {
    command = next_points(now);
  } else if (streaming_) {
    const Axis& axis = axes_[streaming_->axis];
    if (now >= axis.moved + rest_time || now >= streaming_->until) {
      streaming_.reset();
      motion_due_ = now + pause();
      if (auto stream = begin_stream(axis, now)) command = std::move(*stream);
    }
  } else if (now >= motion_due_) {
    motion_due_ = now + pause();
    if (leading_) {
      command = lead();
      motion_due_ = now + time_to_lead;
    } else {
      auto other = gears_ && gear_random_.chance(0.4) ? choose_gear() : std::nullopt;
      if (!other && streams_ && gear_random_.chance(0.4)) {
        choose_stream(now);
      } else {
        command = other ? std::move(*other) : motion();
      }
      if (leading_) motion_due_ = now + time_to_lock;
    }
  } else if (random_.chance(0.1)) {
    add_goals(command, true);
  }
  command.timeout_ms = timeout_ms_;
  command.num_goals = static_cast<std::int32_t>(command.goals.size());
  return command;
}

}  // namespace takt
