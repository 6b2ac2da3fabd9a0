#include "master/motion/planner/motion_planner.hpp"

#include <algorithm>
#include <cmath>

#include "master/motion/beat/profile_player.hpp"
#include "master/motion/beat/stop_profile.hpp"
#include "master/motion/enough_jerk.hpp"

namespace takt::motion {
namespace {

std::uint32_t id_of(const TaggedOrder& sent) noexcept { return sent.order.id; }

/// Returns the state of an order `time` seconds after the start of its motion.
State state_of(const MotionOrder& order, double time) {
  ProfilePlayer player{order.profile, order.from, order.ending};
  return player.at(time);
}

/// Returns true if the first point of a stream is at the position of the axis.
bool is_start(const State& from, const AxisGoal& goal) noexcept {
  constexpr double tolerance = MotionPlanner::start_tolerance;
  const Limits& limits = goal.limits;
  const double start = goal.to.position + turns_to(goal, from.position);
  return std::abs(start - from.position) <= tolerance * std::max(1.0, std::abs(from.position)) &&
         std::abs(goal.to.velocity) <= tolerance * limits.max_velocity &&
         std::abs(goal.to.acceleration) <= tolerance * limits.max_acceleration;
}

/// Returns true if the axis is outside its range, and a jog with this velocity does not bring it
/// back.
bool leads_out(const PositionRange& range, double position, double velocity) noexcept {
  return (position < range.min && velocity <= 0.0) || (position > range.max && velocity >= 0.0);
}

}  // namespace

const MotionOrder* MotionPlanner::Axis::waiting(CycleNumber cycle) const noexcept {
  return !sent.empty() && sent.back().order.begin > cycle ? &sent.back().order : nullptr;
}

const TaggedOrder* MotionPlanner::Axis::find(std::uint32_t id) const noexcept {
  const auto found = std::ranges::find(sent, id, id_of);
  return found == sent.end() ? nullptr : &*found;
}

/// Takes the reports, and forgets orders that are over. An order that did not begin in its cycle
/// never begins, so it is not needed any longer.
void MotionPlanner::observe(CycleNumber cycle, std::span<const AxisReport> reports) {
  cycle_ = cycle;
  for (std::size_t i = 0; i < axes_.size() && i < reports.size(); ++i) {
    Axis& axis = axes_[i];
    axis.report = reports[i];
    std::erase_if(axis.sent, [&](const TaggedOrder& sent) {
      return sent.order.begin <= cycle && sent.order.id != axis.report.running;
    });
  }
}

/// Returns the state that the axis will have in a cycle after the newest report, before the orders
/// of that cycle begin.
std::expected<State, PlanFault> MotionPlanner::state_at(const Axis& axis, CycleNumber cycle) const {
  switch (axis.report.state) {
    case AxisState::unpowered:
      return std::unexpected{PlanFault::not_enabled};
    case AxisState::stopping:
      return std::unexpected{PlanFault::stopping};
    case AxisState::standing:
      return axis.report.commanded;
    case AxisState::moving:
      break;
  }
  const TaggedOrder* running = axis.find(axis.report.running);
  if (running == nullptr) return std::unexpected{PlanFault::foreign};
  if (running->order.ending == Ending::points) return std::unexpected{PlanFault::streaming};
  if (running->order.ending == Ending::gear) {
    return released_at(axis.report, running->order.stop, cycle);
  }
  return state_of(running->order, static_cast<double>(cycle - axis.report.began) * period_);
}

/// Returns the state of an axis whose gear is released. A gear that is not released yet counts as
/// released, so that an impossible motion is refused before the gear ends.
State MotionPlanner::released_at(const AxisReport& report, const Limits& limits,
                                 CycleNumber cycle) const {
  const GearServo servo{limits};
  State state = report.commanded;
  CycleNumber now = cycle_;
  for (; now < cycle && state.acceleration != 0.0; ++now) {
    state = servo.step_to_cruise(state, period_);
  }
  return advanced(state, static_cast<double>(cycle - std::min(now, cycle)) * period_, 0.0);
}

std::expected<CycleNumber, PlanRefusal> MotionPlanner::begin_of(std::span<const AxisGoal> goals,
                                                                CycleNumber begin) const {
  std::optional<CycleNumber> first;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const std::uint8_t axis = goals[i].axis;
    const auto earlier = goals.first(i);
    const bool twice = std::ranges::find(earlier, axis, &AxisGoal::axis) != earlier.end();
    if (axis >= axes_.size() || twice) {
      return std::unexpected{PlanRefusal{.fault = PlanFault::no_axis, .axis = axis}};
    }
    const MotionOrder* waiting = axes_[axis].waiting(cycle_);
    if (waiting == nullptr) continue;
    // Only the bus thread knows which of the sent orders begins. The planner must therefore
    // remember all of them, and it can remember only a few.
    if (waiting->begin <= cycle_ + 1 || axes_[axis].sent.size() >= Axis::most_sent) {
      return std::unexpected{PlanRefusal{.fault = PlanFault::busy, .axis = axis}};
    }
    first = std::max(first.value_or(0), waiting->begin);
  }
  return first.value_or(begin);
}

std::expected<void, PlanRefusal> MotionPlanner::set_tasks(const GroupGoal& group,
                                                          std::span<const AxisGoal> goals,
                                                          CycleNumber begin) {
  tasks_.clear();
  for (const AxisGoal& goal : goals) {
    const auto from = state_at(axes_[goal.axis], begin);
    if (!from) return std::unexpected{PlanRefusal{.fault = from.error(), .axis = goal.axis}};
    // A jog has no range here: it stops in time, see MotionOrder::latest_stop.
    const PositionRange range = group.goal == Goal::position ? goal.range : PositionRange{};
    State to = goal.to;
    if (group.reference == Reference::commanded) {
      to.position += from->position;
    } else {
      to.position += turns_to(goal, from->position);
    }
    const TaggedOrder* running = axes_[goal.axis].find(axes_[goal.axis].report.running);
    const Limits limits = running == nullptr
                              ? goal.limits
                              : with_enough_jerk(goal.limits, *from, running->order.stop);
    tasks_.push_back({.from = *from, .to = to, .limits = limits, .range = range});
  }
  planned_.resize(tasks_.size());
  const TrajectoryOptions options{.goal = group.goal, .synchronisation = group.synchronisation};
  const auto planned = plan_trajectory(tasks_, options, planned_);
  if (planned) return {};
  const Refused& refused = planned.error();
  return std::unexpected{PlanRefusal{
      .fault = PlanFault::impossible, .axis = goals[refused.axis].axis, .defect = refused.defect}};
}

/// Makes the orders of the planned motions. A motion to rest inside the range can be stopped inside
/// it in each cycle, because no motion from the same state with the same limits brakes earlier than
/// a stop.
std::expected<void, PlanRefusal> MotionPlanner::set_orders(const GroupGoal& group,
                                                           std::span<const AxisGoal> goals,
                                                           CycleNumber begin) {
  const bool is_jog = group.goal == Goal::velocity;
  double jog_start = 0.0;
  orders_.clear();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const AxisGoal& goal = goals[i];
    MotionOrder order{.id = id_ + 1,
                      .axis = goal.axis,
                      .group = goals.front().axis,
                      .axes = static_cast<std::uint8_t>(goals.size()),
                      .sender = group.sender,
                      .ending = is_jog ? Ending::cruise : Ending::rest,
                      .begin = begin,
                      .from = tasks_[i].from,
                      .profile = planned_[i].profile,
                      .stop = tasks_[i].limits,
                      .timeout = group.timeout,
                      .max_following_error = goal.max_following_error};
    if (!(planned_[i].duration <= longest_motion * period_)) {
      return std::unexpected{PlanRefusal{.fault = PlanFault::too_long, .axis = goal.axis}};
    }
    if (is_jog) {
      jog_start += planned_[i].duration / period_;
      if (jog_start > longest_jog_start) {
        return std::unexpected{PlanRefusal{.fault = PlanFault::too_long, .axis = goal.axis}};
      }
      const PositionRange range = widened(goal.range, order.from.position);
      const auto latest = cycles_with_stop(order, range, period_, order.latest_stop);
      if (!latest || leads_out(goal.range, order.from.position, goal.to.velocity)) {
        return std::unexpected{PlanRefusal{
            .fault = PlanFault::impossible, .axis = goal.axis, .defect = Defect::position_range}};
      }
      order.latest_stop = *latest;
    }
    orders_.push_back(order);
  }
  return {};
}

std::expected<std::span<const MotionOrder>, PlanRefusal> MotionPlanner::plan(
    const GroupGoal& group, std::span<const AxisGoal> goals, CycleNumber begin) {
  if (cycle_ == 0) return std::unexpected{PlanRefusal{.fault = PlanFault::no_report}};
  const auto first = begin_of(goals, begin);
  if (!first) return std::unexpected{first.error()};
  if (const auto set = set_tasks(group, goals, *first); !set) return std::unexpected{set.error()};
  if (const auto set = set_orders(group, goals, *first); !set) return std::unexpected{set.error()};
  for (const AxisGoal& goal : goals) {
    const GearPhase gear = axes_[goal.axis].report.gear;
    if (gear == GearPhase::approaching || gear == GearPhase::locked) {
      return std::unexpected{PlanRefusal{.fault = PlanFault::geared, .axis = goal.axis}};
    }
  }
  return number_orders(group.tag);
}

std::expected<std::span<const MotionOrder>, PlanRefusal> MotionPlanner::begin_stream(
    const GroupGoal& group, std::span<const AxisGoal> goals, CycleNumber begin) {
  const auto refused = [](PlanFault fault, std::uint8_t axis) {
    return std::unexpected{PlanRefusal{.fault = fault, .axis = axis}};
  };
  if (cycle_ == 0) return refused(PlanFault::no_report, 0);
  orders_.clear();
  for (const AxisGoal& goal : goals) {
    if (goal.axis >= axes_.size()) return refused(PlanFault::no_axis, goal.axis);
    const Axis& axis = axes_[goal.axis];
    if (axis.waiting(cycle_) != nullptr) return refused(PlanFault::busy, goal.axis);
    const auto from = state_at(axis, begin);
    if (!from) return refused(from.error(), goal.axis);
    if (axis.report.state != AxisState::standing) return refused(PlanFault::moving, goal.axis);
    if (!is_start(*from, goal)) return refused(PlanFault::other_start, goal.axis);
    orders_.push_back({.id = id_ + 1,
                       .axis = goal.axis,
                       .group = goals.front().axis,
                       .axes = static_cast<std::uint8_t>(goals.size()),
                       .sender = group.sender,
                       .ending = Ending::points,
                       .begin = begin,
                       .from = *from,
                       .profile = {},
                       .stop = goal.limits,
                       .timeout = group.timeout,
                       .max_following_error = goal.max_following_error});
  }
  return number_orders(group.tag);
}

/// Returns the leader of the newest gear of the axis. Returns std::nullopt if the axis has no gear,
/// or if its leader is no axis.
std::optional<std::uint8_t> MotionPlanner::leader_of(std::uint8_t axis) const noexcept {
  const Axis& follower = axes_[axis];
  const MotionOrder* newest = follower.waiting(cycle_);
  if (newest == nullptr && follower.report.gear != GearPhase::released) {
    const TaggedOrder* running = follower.find(follower.report.running);
    if (running != nullptr) newest = &running->order;
  }
  if (newest == nullptr || newest->ending != Ending::gear) return std::nullopt;
  return newest->gear.leader_axis < axes_.size() ? std::optional{newest->gear.leader_axis}
                                                 : std::nullopt;
}

/// Returns the axis among the goals that the leader follows, directly or through other axes.
std::optional<std::uint8_t> MotionPlanner::axis_that_leads(
    std::uint8_t leader, std::span<const AxisGoal> goals) const noexcept {
  std::optional<std::uint8_t> next = leader;
  for (std::size_t i = 0; next && *next < axes_.size() && i < axes_.size(); ++i) {
    if (std::ranges::find(goals, *next, &AxisGoal::axis) != goals.end()) return next;
    next = leader_of(*next);
  }
  return std::nullopt;
}

std::expected<std::span<const MotionOrder>, PlanRefusal> MotionPlanner::begin_gear(
    const GroupGoal& group, std::span<const AxisGoal> goals, std::span<const GearTask> tasks,
    CycleNumber begin) {
  const auto refused = [](PlanFault fault, std::uint8_t axis) {
    return std::unexpected{PlanRefusal{.fault = fault, .axis = axis}};
  };
  if (cycle_ == 0) return refused(PlanFault::no_report, 0);
  const auto first = begin_of(goals, begin);
  if (!first) return std::unexpected{first.error()};
  if (const auto axis = axis_that_leads(tasks.front().leader_axis, goals)) {
    return refused(PlanFault::ring, *axis);
  }
  orders_.clear();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const AxisGoal& goal = goals[i];
    const AxisState state = axes_[goal.axis].report.state;
    if (state == AxisState::unpowered) return refused(PlanFault::not_enabled, goal.axis);
    if (state == AxisState::stopping) return refused(PlanFault::stopping, goal.axis);
    orders_.push_back({.id = id_ + 1,
                       .axis = goal.axis,
                       .group = goals.front().axis,
                       .axes = static_cast<std::uint8_t>(goals.size()),
                       .sender = group.sender,
                       .ending = Ending::gear,
                       .begin = *first,
                       .from = {},
                       .profile = {},
                       .gear = tasks[i],
                       .stop = goal.limits,
                       .timeout = group.timeout,
                       .max_following_error = goal.max_following_error});
  }
  return number_orders(group.tag);
}

/// Uses the next id for the orders, and remembers them.
std::span<const MotionOrder> MotionPlanner::number_orders(const MotionTag& tag) {
  ++id_;
  for (const MotionOrder& order : orders_) {
    std::vector<TaggedOrder>& sent = axes_[order.axis].sent;
    sent.push_back({.order = order, .tag = tag});
  }
  return orders_;
}

}  // namespace takt::motion
