#include "master/gateway/motion/motion_goals.hpp"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "master/gateway/motion/motion_senders.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time default_motion_timeout = 500ms;

std::optional<motion::Synchronisation> synchronisation_of(const std::string& name) {
  if (name.empty() || name == "time") return motion::Synchronisation::time;
  if (name == "phase") return motion::Synchronisation::phase;
  if (name == "none") return motion::Synchronisation::none;
  return std::nullopt;
}

std::expected<motion::AxisGoal, MotionRefusal> axis_goal(const motion_goal_t& goal,
                                                         std::size_t axis, motion::Goal kind,
                                                         const AxisMotionLimits& limits) {
  const auto refused = [&](std::string why) {
    return std::unexpected{MotionRefusal{.why = std::move(why), .axis = axis}};
  };
  const auto within = limits.of(axis, goal);
  if (!within) return refused(within.error());
  const bool is_jog = kind == motion::Goal::velocity;
  const double wanted = is_jog ? goal.velocity : goal.position;
  if (!(std::abs(wanted) <= AxisMotionLimits::largest)) {
    return refused(fmt::format("its target {} is infinite, NaN or too large", wanted));
  }
  const auto following_error = limits.following_error(axis, goal);
  if (!following_error) return refused(following_error.error());
  return motion::AxisGoal{
      .axis = static_cast<std::uint8_t>(axis),
      .to = {.position = is_jog ? 0.0 : goal.position, .velocity = is_jog ? goal.velocity : 0.0},
      .limits = *within,
      .range = limits.range(axis),
      .turn = limits.turn(axis),
      .max_following_error = *following_error};
}

/// Returns a command with the fields that a message of another type has in common with a command.
template <class T>
motion_command_t command_of(const T& message, const std::string& kind) {
  motion_command_t command{};
  command.utime = message.utime;
  command.schema = message.schema;
  command.session = message.session;
  command.instance = message.instance;
  command.sender = message.sender;
  command.cycle = message.cycle;
  command.id = message.id;
  command.kind = kind;
  command.timeout_ms = message.timeout_ms;
  command.goals = message.goals;
  command.num_goals = message.num_goals;
  return command;
}

}  // namespace

bool is_motion_timeout(std::int32_t milliseconds) noexcept {
  return milliseconds >= 0 && milliseconds <= MotionSenders::longest_timeout / 1ms;
}

Time motion_timeout_of(const motion_command_t& command) noexcept {
  const bool given = command.timeout_ms != 0 && is_motion_timeout(command.timeout_ms);
  return given ? std::chrono::milliseconds{command.timeout_ms} : default_motion_timeout;
}

std::uint64_t cycles_in(Time span, Time period) noexcept {
  return period <= Time{0} ? 1 : static_cast<std::uint64_t>((span + period - Time{1}) / period);
}

motion_command_t command_of(const motion_gear_t& gear) { return command_of(gear, "gear"); }

motion_command_t command_of(const motion_stream_t& stream) {
  motion_command_t command = command_of(stream, "stream");
  for (std::size_t i = 0; i < command.goals.size() && !stream.points.empty(); ++i) {
    const auto& positions = stream.points.front().position;
    command.goals[i].position = i < positions.size() ? positions[i] : 0.0;
  }
  return command;
}

std::expected<MotionJob, MotionRefusal> motion_job(const motion_command_t& command,
                                                   std::span<const std::size_t> axes,
                                                   const AxisMotionLimits& limits, Time period) {
  const auto synchronisation = synchronisation_of(command.synchronisation);
  if (!synchronisation) {
    return std::unexpected{
        MotionRefusal{.why = "its synchronisation is not one of \"time\", \"phase\", \"none\""}};
  }
  MotionJob job{.name = {.id = command.id, .sender = command.sender}, .instance = command.instance};
  job.group.goal = command.kind == "jog" ? motion::Goal::velocity : motion::Goal::position;
  job.group.synchronisation = *synchronisation;
  if (command.kind == "move_by") job.group.reference = motion::Reference::commanded;
  job.group.timeout = cycles_in(motion_timeout_of(command), period);
  job.group.tag = {.id = command.id, .instance = command.instance};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto goal = axis_goal(command.goals[i], axes[i], job.group.goal, limits);
    if (!goal) return std::unexpected{goal.error()};
    job.goals.push_back(*goal);
  }
  return job;
}

std::expected<MotionJob, MotionRefusal> stream_job(const motion_stream_t& stream,
                                                   const motion_command_t& command,
                                                   std::span<const std::size_t> axes,
                                                   const AxisMotionLimits& limits, Time period) {
  auto job = motion_job(command, axes, limits, period);
  if (!job) return job;
  const motion_point_t& first = stream.points.front();
  if (first.position.size() != axes.size() || first.velocity.size() != axes.size()) {
    return std::unexpected{
        MotionRefusal{.why = "its point 0 needs one position and one velocity for each axis"}};
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double acceleration = i < first.acceleration.size() ? first.acceleration[i] : 0.0;
    job->goals[i].to = {
        .position = first.position[i], .velocity = first.velocity[i], .acceleration = acceleration};
  }
  return job;
}

}  // namespace takt
