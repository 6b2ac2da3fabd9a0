#include "master/motion/beat/axis_motions.hpp"

#include <algorithm>
#include <bitset>
#include <limits>

namespace takt::motion {

AxisMotions::AxisMotions(std::size_t axes, double period) : reports_(std::min(axes, max_axes)) {
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    runners_.emplace_back(period, static_cast<std::uint8_t>(i));
  }
}

Outcome AxisMotions::take(const MotionOrder& order) noexcept {
  if (order.axis >= runners_.size() || order.group >= runners_.size()) return Outcome::unsound;
  return runners_[order.axis].wait(order);
}

void AxisMotions::sender_heard(std::uint8_t sender, CycleNumber cycle) noexcept {
  if (sender < max_axes) heard_[sender] = std::max(heard_[sender], cycle);
}

void AxisMotions::stop_axis(std::uint8_t axis, StopCause cause) noexcept {
  if (axis >= runners_.size()) return;
  if (runners_[axis].waiting() != nullptr) runners_[axis].refuse(Outcome::stopped);
  add_stop(axis, cause);
}

void AxisMotions::sender_left(std::uint8_t axis, std::uint8_t sender) noexcept {
  if (axis < runners_.size() && runners_[axis].sender() == sender) runners_[axis].forget_sender();
}

void AxisMotions::abandon(std::uint8_t axis, StopCause cause) noexcept {
  add_stop(axis, cause);
  runners_[axis].abandon({.cause = cause, .axis = axis});
  runners_[axis].leave_group();
}

bool AxisMotions::outlives_gap(std::uint8_t axis, CycleNumber cycle) const noexcept {
  return runners_[axis].outlives(silence_of(runners_[axis].sender(), cycle));
}

void AxisMotions::abandon_all(StopCause cause) noexcept {
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    runners_[i].abandon({.cause = cause, .axis = static_cast<std::uint8_t>(i)});
  }
}

void AxisMotions::stop_all(StopCause cause) noexcept {
  for (std::size_t i = 0; i < runners_.size(); ++i) stop_axis(static_cast<std::uint8_t>(i), cause);
}

/// Makes the group of the axis stop in the next run(). Two motions can have the same group while
/// one of them replaces the other axis by axis. If both have a cause to stop in the same cycle, all
/// axes of the group stop.
void AxisMotions::add_stop(std::size_t axis, StopCause cause) noexcept {
  GroupStop& stop = stops_[runners_[axis].group()];
  const std::uint32_t id = runners_[axis].newest();
  if (stop.stop.cause == StopCause::none) {
    stop = {.stop = {.cause = cause, .axis = static_cast<std::uint8_t>(axis)},
            .id = id,
            .of_all = false};
  } else if (stop.id != id) {
    stop.of_all = true;
  }
}

std::span<const AxisReport> AxisMotions::run(CycleNumber cycle,
                                             std::span<const AxisInput> inputs) noexcept {
  observe(cycle, inputs);
  stop_groups();
  begin_orders(cycle);
  run_axes(cycle, inputs);
  stop_split_streams();
  for (AxisRunner& runner : runners_) runner.forget_ended();
  return reports_;
}

/// Runs all axes. A gear runs after its leader, because it needs the state of the leader in this
/// cycle. The axes of a ring of gears have no such order: they run as if their leaders were lost. A
/// ring of measured positions counts as a ring, too: each axis would follow its own movement, and
/// this movement would grow unless the ratios reduce it.
void AxisMotions::run_axes(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept {
  std::bitset<max_axes> waiting;
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const bool waits = runners_[i].has_leader() && runners_[i].gear().leader_axis < runners_.size();
    waiting[i] = waits;
    if (waits) continue;
    if (runners_[i].has_gear()) follow(i, inputs);
    reports_[i] = runners_[i].run(cycle);
  }
  for (bool advances = true; advances && waiting.any();) {
    advances = false;
    for (std::size_t i = 0; i < runners_.size(); ++i) {
      const std::size_t leader = runners_[i].gear().leader_axis;
      if (!waiting[i] || waiting[leader]) continue;
      follow(i, inputs);
      reports_[i] = runners_[i].run(cycle);
      waiting[i] = false;
      advances = true;
    }
  }
  for (std::size_t i = 0; waiting.any() && i < runners_.size(); ++i) {
    if (!waiting[i]) continue;
    const StopCause cause = runners_[i].follow({.state = {}, .is_lost = true}, {});
    if (cause != StopCause::none) add_stop(i, cause);
    reports_[i] = runners_[i].run(cycle);
    waiting[i] = false;
  }
}

/// Makes a step of the gear of the axis. If the axis has to stop, the other axes of its group stop
/// in the next cycle.
void AxisMotions::follow(std::size_t axis, std::span<const AxisInput> inputs) noexcept {
  AxisRunner& runner = runners_[axis];
  const GearTask& task = runner.gear();
  LeaderState leader;
  if (task.leader_axis < runners_.size()) {
    const AxisReport& report = reports_[task.leader_axis];
    const AxisInput& input = inputs[task.leader_axis];
    leader.state = report.commanded;
    leader.is_lost = task.kind == LeaderKind::commanded
                         ? report.state == AxisState::unpowered
                         : input.condition == AxisCondition::fault ||
                               input.condition == AxisCondition::lost ||
                               input.homing == HomingState::runs;
  } else {
    leader.is_lost = task.kind == LeaderKind::commanded;
  }
  const StopCause cause = runner.follow(leader, inputs[axis].sample_of(task.signal));
  if (cause != StopCause::none) add_stop(axis, cause);
}

/// Stops groups in which one axis has ended its stream while another axis has more points. All axes
/// of a stream have the same last point, so these points have come too late for the first axis. The
/// group stops in the next cycle.
void AxisMotions::stop_split_streams() noexcept {
  const auto is_done = [](const AxisRunner& runner) { return runner.has_done_stream(); };
  if (std::ranges::none_of(runners_, is_done)) return;
  struct Moving {
    std::uint32_t stream = 0;
    double until = 0.0;
  };
  std::array<Moving, max_axes> moving{};  // indexed by group
  for (const AxisRunner& runner : runners_) {
    Moving& other = moving[runner.group()];
    const bool is_first = other.stream != runner.newest();
    if (!runner.is_streaming() || (!is_first && other.until > runner.end_of_points())) continue;
    other = {.stream = runner.newest(), .until = runner.end_of_points()};
  }
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const AxisRunner& runner = runners_[i];
    const Moving& other = moving[runner.group()];
    const bool has_less = is_done(runner) && other.until > runner.end_of_points();
    if (has_less && other.stream == runner.newest()) add_stop(i, StopCause::points_ended);
  }
}

std::size_t AxisMotions::points() const noexcept {
  std::size_t sum = 0;
  for (const AxisRunner& runner : runners_) sum += runner.points();
  return sum;
}

void AxisMotions::observe(CycleNumber cycle, std::span<const AxisInput> inputs) noexcept {
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const Silence silence{.sender = silence_of(runners_[i].sender(), cycle),
                          .jog = runners_[i].jog_silence(runners_[i].sender(), cycle)};
    const StopCause cause = runners_[i].observe(cycle, inputs[i], silence);
    if (cause != StopCause::none) add_stop(i, cause);
  }
}

void AxisMotions::stop_groups() noexcept {
  for (AxisRunner& runner : runners_) {
    const GroupStop& stop = stops_[runner.group()];
    if (stop.stop.cause == StopCause::none) continue;
    if (stop.of_all || stop.id == runner.newest()) runner.stop(stop.stop);
  }
  stops_ = {};
}

/// An order begins if all orders of its group are due, have its id, and may begin.
void AxisMotions::begin_orders(CycleNumber cycle) noexcept {
  std::array<Outcome, max_axes> objections{};
  std::array<std::uint8_t, max_axes> ready{};  // number of orders that may begin, indexed by group
  const auto leads = [&](const MotionOrder& order) {
    if (order.group >= runners_.size()) return false;
    const MotionOrder* first = runners_[order.group].due(cycle);
    return first != nullptr && first->id == order.id;
  };
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const MotionOrder* order = runners_[i].due(cycle);
    if (order == nullptr) continue;
    objections[i] = objection_of(i, cycle);
    if (objections[i] == Outcome::none && leads(*order)) ++ready[order->group];
  }
  std::array<Outcome, max_axes> verdicts{};
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const MotionOrder* order = runners_[i].due(cycle);
    if (order == nullptr) continue;
    const bool complete = leads(*order) && ready[order->group] == order->axes;
    const Outcome rest = complete ? Outcome::none : Outcome::group_incomplete;
    verdicts[i] = objections[i] != Outcome::none ? objections[i] : rest;
  }
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    if (runners_[i].due(cycle) == nullptr) continue;
    if (verdicts[i] == Outcome::none) {
      runners_[i].begin(cycle);
    } else {
      runners_[i].refuse(verdicts[i]);
    }
  }
}

Outcome AxisMotions::objection_of(std::size_t axis, CycleNumber cycle) noexcept {
  const MotionOrder& order = *runners_[axis].due(cycle);
  const CycleNumber silence = order.ending == Ending::cruise
                                  ? runners_[axis].jog_silence(order.sender, cycle)
                                  : silence_of(order.sender, cycle);
  if (silence > order.timeout) return Outcome::sender_was_silent;
  return runners_[axis].objection(cycle);
}

CycleNumber AxisMotions::silence_of(std::uint8_t sender, CycleNumber cycle) const noexcept {
  if (sender >= max_axes) return std::numeric_limits<CycleNumber>::max();
  return cycle - std::min(heard_[sender], cycle);
}

}  // namespace takt::motion
