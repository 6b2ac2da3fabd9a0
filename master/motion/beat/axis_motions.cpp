#include "master/motion/beat/axis_motions.hpp"

namespace takt::motion {

AxisMotions::AxisMotions(std::size_t axes, double period)
    : runners_(axes, AxisRunner{period}), reports_(axes) {}

bool AxisMotions::take(const MotionOrder& order, Cycle cycle) noexcept {
  if (order.axis >= runners_.size() || order.group >= max_axes) return false;
  sender_heard(order.group, cycle);
  runners_[order.axis].wait(order);
  return true;
}

void AxisMotions::stop_group(std::uint8_t group, StopCause cause) noexcept {
  if (stops_[group].cause == StopCause::none) stops_[group] = {.cause = cause};
}

void AxisMotions::stop_all(StopCause cause) noexcept {
  for (const AxisRunner& runner : runners_) stop_group(runner.group(), cause);
}

std::span<const AxisReport> AxisMotions::run(Cycle cycle,
                                             std::span<const AxisInput> inputs) noexcept {
  observe(cycle, inputs);
  stop_groups(cycle);
  begin_orders(cycle);
  for (std::size_t i = 0; i < runners_.size(); ++i) reports_[i] = runners_[i].run(cycle);
  return reports_;
}

void AxisMotions::observe(Cycle cycle, std::span<const AxisInput> inputs) noexcept {
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const std::uint8_t group = runners_[i].group();
    const StopCause cause = runners_[i].observe(cycle, inputs[i], cycle - heard_[group]);
    Stop& stop = stops_[group];
    if (cause == StopCause::none || stop.cause != StopCause::none) continue;
    stop = {.cause = cause, .axis = static_cast<std::uint8_t>(i)};
  }
}

void AxisMotions::stop_groups(Cycle cycle) noexcept {
  for (AxisRunner& runner : runners_) {
    const Stop& stop = stops_[runner.group()];
    if (stop.cause != StopCause::none) runner.stop(cycle, stop);
  }
  stops_ = {};
}

void AxisMotions::begin_orders(Cycle cycle) noexcept {
  ready_ = {};
  std::array<Outcome, max_axes> objections{};
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const MotionOrder* order = runners_[i].due(cycle);
    if (order == nullptr) continue;
    objections[i] = objection_of(i, cycle);
    if (objections[i] != Outcome::none) continue;
    Ready& ready = ready_[order->group];
    if (ready.id != order->id) ready = {.id = order->id};
    ++ready.orders;
  }
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const MotionOrder* order = runners_[i].due(cycle);
    if (order == nullptr) continue;
    const Ready& ready = ready_[order->group];
    if (objections[i] != Outcome::none) {
      runners_[i].refuse(objections[i]);
    } else if (ready.id != order->id || ready.orders != order->axes) {
      runners_[i].refuse(Outcome::group_incomplete);
    } else {
      runners_[i].begin(cycle);
    }
  }
}

Outcome AxisMotions::objection_of(std::size_t axis, Cycle cycle) noexcept {
  const MotionOrder& order = *runners_[axis].due(cycle);
  if (cycle - heard_[order.group] > order.timeout) return Outcome::sender_was_silent;
  return runners_[axis].objection(cycle);
}

}  // namespace takt::motion
