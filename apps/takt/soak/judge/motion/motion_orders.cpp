#include "apps/takt/soak/judge/motion/motion_orders.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

// Number of cycles from the end of a timeout until the motion no longer keeps the outputs of its
// node valid.
constexpr unsigned cycles_kept_alive = 16;
// Number of cycles from the end of a timeout to the last frame.
constexpr unsigned cycles_to_the_wire = 6;
constexpr Time oldest_message = 1s;  // older messages are refused
constexpr Time usual_timeout = 500ms;
constexpr Time longest_creep = 5s;   // longest time in which a slow axis moves by one count
constexpr double usual_rise = 0.05;  // s until the acceleration is reached

MotionBounds larger(const MotionBounds& a, const MotionBounds& b) noexcept {
  return {.velocity = std::max(a.velocity, b.velocity),
          .acceleration = std::max(a.acceleration, b.acceleration),
          .jerk = std::max(a.jerk, b.jerk)};
}

std::size_t number_of(SenderBit sender) noexcept {
  return static_cast<std::size_t>(std::countr_zero(sender));
}

}  // namespace

Time MotionOrders::stop_time(const MotionBounds& bounds, const MotionBounds& fastest) noexcept {
  const double speed =
      fastest.velocity + fastest.acceleration * fastest.acceleration / (2 * bounds.jerk);
  const double seconds =
      speed / bounds.acceleration + (bounds.acceleration + fastest.acceleration) / bounds.jerk;
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>{1.02 * seconds});
}

MotionOrders::MotionOrders(const BusPlan& plan)
    : plan_{plan},
      axes_{motion_axes(plan)},
      file_(axes_.size()),
      orders_(axes_.size()),
      longest_(axes_.size()),
      named_(axes_.size()) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double size = std::abs(plan.layout.signals[axes_[i].target].scale);
    for (const LimitLine& line : plan.limits.lines) {
      const bool mine = line.node_index == axes_[i].node_index && line.axis == axes_[i].number + 1;
      if (!mine || !line.high) continue;
      if (line.kind == LimitKind::velocity) file_[i].velocity = *line.high / size;
      if (line.kind == LimitKind::acceleration) file_[i].acceleration = *line.high / size;
      if (line.kind == LimitKind::jerk) file_[i].jerk = *line.high / size;
    }
  }
}

std::optional<std::size_t> MotionOrders::axis_of(SignalIndex output) const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].target == output || axes_[i].velocity_offset == output) return i;
  }
  return std::nullopt;
}

void MotionOrders::commanded(const SentMotion& sent, Time now) {
  Time& newest = heard_[number_of(sent.sender)];
  newest = std::max(newest, sent.computed_from);
  const std::string& kind = sent.command.kind;
  if (kind == "stop") return;
  const bool begins = kind == "move" || kind == "jog" || kind == "gear" || kind == "stream";
  if (begins) ++messages_;
  if (kind == "gear") ++gears_;
  if (kind == "stream") ++streams_;
  for (const motion_goal_t& goal : sent.command.goals) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const bool named = plan_.nodes[axes_[i].node_index].name == goal.node &&
                         axes_[i].number + 1 == std::max<int>(goal.axis, 1);
      if (!named) continue;
      Time& renewed = named_[i][number_of(sent.sender)];
      if (kind != "move") renewed = std::max(renewed, sent.computed_from);
      if (begins) add(sent, goal, i, now);
      if (kind != "points") continue;
      for (OrderedMotion& order : orders_[i]) take_points(sent, order, now);
    }
  }
}

void MotionOrders::add(const SentMotion& sent, const motion_goal_t& goal, std::size_t axis,
                       Time now) {
  ++motions_;
  const auto asked = std::chrono::milliseconds{sent.command.timeout_ms};
  OrderedMotion order{
      .message = messages_,
      .group_size = sent.command.goals.size(),
      .creeps = sent.command.goals.size() > 1 && sent.command.synchronisation != "none",
      .sender = sent.sender,
      .sent = now,
      .computed_from = sent.computed_from,
      .timeout = sent.command.timeout_ms == 0 ? usual_timeout : Time{asked},
      .bounds = bounds_of(goal, axis),
      .follows = sent.command.kind == "gear"};
  if (sent.command.kind == "stream") order.stream = sent.command.id;
  if (sent.command.kind == "move" || order.stream) {
    const Signal& target = plan_.layout.signals[axes_[axis].target];
    order.target = std::llround((goal.position - target.offset) / target.scale);
  }
  order.fastest = larger(order.bounds, bounds(axis, now).value_or(order.bounds));
  take_points(sent, order, now);
  std::vector<OrderedMotion>& orders = orders_[axis];
  std::erase_if(orders,
                [&](const OrderedMotion& older) { return end_of(axis, older) + 500ms < now; });
  Time& longest = longest_[axis][number_of(order.sender)];
  longest = std::max(longest, order.timeout + stop_time(order.bounds, order.fastest));
  orders.push_back(order);
}

/// A missed cycle delays a stream by a period. Therefore the end is computed with twice the time of
/// the remaining points, and with a tenth of the elapsed time in addition.
void MotionOrders::take_points(const SentMotion& sent, OrderedMotion& order,
                               Time now) const noexcept {
  if (order.stream != sent.command.id || order.sender != sent.sender) return;
  const Time elapsed = now - order.sent;
  const Time left = std::max(Time{}, sent.points_until - elapsed);
  order.points_end = now + longest_way + 2 * left + elapsed / 10 +
                     stop_time(order.bounds, order.fastest) +
                     cycles_to_the_wire * plan_.cycle.period;
}

MotionBounds MotionOrders::bounds_of(const motion_goal_t& goal, std::size_t axis) const noexcept {
  const double size = std::abs(plan_.layout.signals[axes_[axis].target].scale);
  const auto either = [&](double own, double of_file) { return own != 0 ? own / size : of_file; };
  MotionBounds bounds{.velocity = either(goal.max_velocity, file_[axis].velocity),
                      .acceleration = either(goal.max_acceleration, file_[axis].acceleration),
                      .jerk = either(goal.max_jerk, file_[axis].jerk)};
  if (bounds.jerk == 0) bounds.jerk = bounds.acceleration / usual_rise;
  return bounds;
}

void MotionOrders::begin_anew() {
  for (auto& orders : orders_) orders.clear();
  for (auto& longest : longest_) longest.fill({});
  for (auto& named : named_) named.fill({});
  heard_.fill({});
}

Time MotionOrders::heard(SenderBit sender) const noexcept { return heard_[number_of(sender)]; }

/// A message may travel for `oldest_message`. Its motion may then wait for the timeout and 20
/// periods before it begins.
Time MotionOrders::latest_begin(const OrderedMotion& order) const noexcept {
  return order.computed_from + oldest_message + order.timeout + 20 * plan_.cycle.period;
}

Time MotionOrders::end_of(std::size_t axis, const OrderedMotion& order) const noexcept {
  const bool is_jog = !order.target && !order.follows;
  const Time last = is_jog ? named_[axis][number_of(order.sender)] : heard(order.sender);
  const Time silent = last + order.timeout + stop_time(order.bounds, order.fastest) +
                      cycles_to_the_wire * plan_.cycle.period;
  return std::min({silent, order.ended, order.points_end});
}

/// The motion of an axis at standstill may not have ended. An axis that waits for the others of its
/// group may need seconds for one count, and an axis that follows a leader moves again when its
/// leader moves.
void MotionOrders::stood(std::size_t axis, Time since, Time now) {
  std::erase_if(orders_[axis], [&](const OrderedMotion& order) {
    return !order.follows && latest_begin(order) < since &&
           (!order.creeps || now - since > longest_creep);
  });
}

void MotionOrders::arrived(std::size_t axis, const OrderedMotion& order) {
  const OrderedMotion last = order;
  std::erase_if(orders_[axis], [&](const OrderedMotion& one) {
    return one.sender == last.sender && one.message <= last.message;
  });
}

void MotionOrders::failed(std::size_t axis, Time now) {
  if (orders_[axis].empty()) return;
  const OrderedMotion newest = orders_[axis].back();
  const auto end = [&](OrderedMotion& order) {
    if (order.sent + longest_way >= now) return;  // the motion may still begin
    const Time at_rest =
        now + stop_time(order.bounds, order.fastest) + cycles_to_the_wire * plan_.cycle.period;
    order.ended = std::min(order.ended, at_rest);
  };
  for (OrderedMotion& order : orders_[axis]) end(order);
  for (auto& orders : orders_) {
    for (OrderedMotion& order : orders) {
      if (order.message == newest.message) end(order);
    }
  }
}

/// A motion that takes over from a faster one needs some time until it is within its own limits.
std::optional<MotionBounds> MotionOrders::bounds(std::size_t axis, Time now) const noexcept {
  std::optional<MotionBounds> found;
  for (const OrderedMotion& order : orders_[axis]) {
    if (now > end_of(axis, order)) continue;
    const Time slow = order.sent + longest_way + stop_time(order.bounds, order.fastest);
    const MotionBounds& own = now <= slow ? order.fastest : order.bounds;
    found = larger(found.value_or(own), own);
  }
  return found;
}

SenderBit MotionOrders::mover(std::size_t axis, Time now) const noexcept {
  SenderBit senders = 0;
  for (const OrderedMotion& order : orders_[axis]) {
    if (now <= end_of(axis, order)) senders |= order.sender;
  }
  return std::has_single_bit(senders) ? senders : 0;
}

bool MotionOrders::keeps_alive(std::size_t node_index, Time now) const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].node_index != node_index) continue;
    for (std::size_t sender = 0; sender < most_senders; ++sender) {
      const Time longest = longest_[i][sender];
      const Time slack = cycles_kept_alive * plan_.cycle.period;
      if (longest != Time{} && now <= heard_[sender] + longest + slack) return true;
    }
  }
  return false;
}

bool MotionOrders::was_commanded(std::size_t axis) const noexcept {
  return std::ranges::any_of(longest_[axis], [](Time longest) { return longest != Time{}; });
}

}  // namespace takt::soak
