#include "apps/move/beat_move.hpp"

#include <algorithm>
#include <utility>

#include "apps/axis/group/find_axes.hpp"
#include "apps/move/held_axes.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

/// Time between signs of life.
constexpr std::chrono::milliseconds pause{50};
/// Time between two stop messages if no image comes.
constexpr std::chrono::milliseconds stop_pause{10};
/// Number of images after which taktd has certainly received a command. The set-points of taktd are
/// at most three cycles ahead of the images.
constexpr int images_to_stop = 20;
/// The move stops if this program is silent for this time, as a move by set-points would stop.
constexpr std::int32_t timeout_ms = 1000;
/// Values of axis_motion_t::state and axis_motion_t::outcome.
constexpr std::int8_t not_enabled = 0;
constexpr std::int8_t moves = 2;
constexpr std::int8_t done = 1;
constexpr std::int8_t refused = 4;

}  // namespace

BeatMove::BeatMove(AxisGroup& group)
    : group_{group}, id_{static_cast<std::int32_t>(random_number() & 0x3FFF'FFFF) + 1} {}

template <class Is>
bool BeatMove::all(Is is) const {
  return std::ranges::all_of(numbers_of(group_.axes()), [&](AxisControl::Index axis) {
    const auto motion = group_.motion(axis);
    return motion && is(*motion);
  });
}

bool BeatMove::offered() const {
  return all([](const axis_motion_t& motion) { return motion.state != not_enabled; });
}

bool BeatMove::moving() const {
  return !all([](const axis_motion_t& motion) { return motion.state < moves; });
}

BeatMove::Course BeatMove::course() const {
  const auto knows = [this](const axis_motion_t& motion) {
    return motion.id == id_ || motion.ended_id == id_;
  };
  if (!all(knows)) return Course::unanswered;
  if (moving() || !all([this](const axis_motion_t& motion) { return motion.id != id_; })) {
    return Course::runs;
  }
  const auto all_ended = [this](std::int8_t outcome) {
    return all([outcome](const axis_motion_t& motion) { return motion.outcome == outcome; });
  };
  if (all_ended(done)) return Course::done;
  return all_ended(refused) ? Course::refused : Course::stopped;
}

void BeatMove::keep_alive() {
  if (phase_ == Phase::stops || Clock::now() - sent_ < pause) return;
  motion_command_t command{};
  command.kind = "alive";
  send(std::move(command));
}

motion_command_t BeatMove::command_for(const char* kind) const {
  motion_command_t command{};
  command.kind = kind;
  command.id = id_;
  for (const AxisControl::Index i : numbers_of(group_.axes())) {
    const std::size_t place = *group_.axes().signals(i).controlword;
    const signal_t& controlword = group_.input().signals()[place];
    motion_goal_t goal{};
    goal.node = controlword.node;
    goal.axis = number_of_axis(controlword.index);
    command.goals.push_back(std::move(goal));
  }
  return command;
}

void BeatMove::begin(const Eigen::VectorXd& to, std::span<const MotionLimits> limits) {
  ++id_;
  phase_ = Phase::lives;
  motion_command_t command = command_for("move");
  command.synchronisation = "phase";
  for (std::size_t i = 0; i < limits.size(); ++i) {
    motion_goal_t& goal = command.goals[i];
    goal.position = to(static_cast<Eigen::Index>(i));
    goal.max_velocity = limits[i].velocity;
    goal.max_acceleration = limits[i].acceleration;
    goal.max_jerk = limits[i].jerk;
  }
  send(std::move(command));
}

void BeatMove::stop() {
  if (std::exchange(phase_, Phase::stops) == Phase::lives) {
    stopped_images_ = 0;
    stop_cycle_ = -1;
  }
  const std::int64_t cycle = group_.input().cycle();
  if (cycle == stop_cycle_ && Clock::now() - sent_ < stop_pause) return;
  if (cycle != stop_cycle_) ++stopped_images_;
  stop_cycle_ = cycle;
  send(command_for("stop"));
}

bool BeatMove::stands_after_stop() const {
  return phase_ == Phase::stops && stopped_images_ > images_to_stop && !moving() &&
         course() != Course::runs;
}

bool BeatMove::take_news() {
  std::vector<Report> reports;
  for (const AxisControl::Index i : numbers_of(group_.axes())) {
    const auto motion = group_.motion(i).value_or(axis_motion_t{});
    reports.emplace_back(motion.position, motion.time_left);
  }
  return std::exchange(reports_, reports) != reports;
}

Eigen::VectorXd BeatMove::positions() const {
  Eigen::VectorXd positions = group_.axes().target_positions();
  for (const AxisControl::Index i : numbers_of(group_.axes())) {
    if (const auto motion = group_.motion(i)) positions(i) = motion->position;
  }
  return positions;
}

void BeatMove::send(motion_command_t command) {
  command.timeout_ms = timeout_ms;
  sent_ = Clock::now();
  group_.send_motion(command);
}

}  // namespace takt
