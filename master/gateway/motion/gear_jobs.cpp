#include "master/gateway/motion/gear_jobs.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace takt {
namespace {

constexpr double default_filter_time = 0.02;  // s
constexpr double longest_filter_time = 10.0;  // s
constexpr double cycles_of_lead = 2.0;
constexpr double largest_ratio = 1e9;

using Task = std::expected<motion::GearTask, MotionRefusal>;

Task refused(std::string why) { return std::unexpected{MotionRefusal{.why = std::move(why)}}; }

std::optional<std::size_t> node_of(const BusPlan& plan, const std::string& name) {
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (plan.nodes[i].name == name) return i;
  }
  return std::nullopt;
}

/// Returns the task for a leader that is the commanded position of an axis.
Task commanded_leader(const motion_gear_t& gear, std::size_t node,
                      std::span<const std::size_t> axes, const KnownAxes& known) {
  const int number = std::max<int>(gear.leader_axis, 1) - 1;
  const auto found = std::ranges::find_if(known.axes, [&](const MotionAxis& axis) {
    return axis.node_index == node && axis.number == number;
  });
  if (found == known.axes.end()) {
    return refused(
        fmt::format("its leader '{:.64}' has no axis {} that taktd can move: name a "
                    "signal of this node",
                    gear.leader, number + 1));
  }
  const auto place = static_cast<std::size_t>(found - known.axes.begin());
  if (std::ranges::find(axes, place) != axes.end()) return refused("an axis can't follow itself");
  const Signal& target = known.plan.layout.signals[found->target];
  const Turn turn = found->turn.in_unit(target.scale, target.offset);
  return motion::GearTask{.kind = motion::LeaderKind::commanded,
                          .leader_axis = static_cast<std::uint8_t>(place),
                          .modulo = turn.length,
                          .zero = turn.lowest};
}

/// Returns true if the signal is one of the objects of this axis.
bool is_of(const Signal& signal, const MotionAxis& axis) noexcept {
  return signal.node_index == axis.node_index && axis_of(signal.object) == axis.number;
}

/// Returns true if the signal is a position that follows the target position of this axis: the
/// actual and the demanded one (CiA 402-2, 0x6062 to 0x6064 and 0x60FC).
bool is_position_of(const Signal& signal, const MotionAxis& axis) noexcept {
  constexpr std::array<std::uint16_t, 4> positions{0x6062, 0x6063, 0x6064, 0x60FC};
  return signal.node_index == axis.node_index &&
         std::ranges::any_of(positions, [&](std::uint16_t index) {
           return signal.object == axis_object(axis.number, index);
         });
}

Task measured_leader(const motion_gear_t& gear, std::size_t node, std::span<const std::size_t> axes,
                     const KnownAxes& known) {
  const ImageLayout& layout = known.plan.layout;
  const auto inputs = std::span{layout.signals}.first(layout.inputs);
  const auto found = std::ranges::find_if(inputs, [&](const Signal& signal) {
    return signal.node_index == node && signal.name == gear.signal;
  });
  if (found == inputs.end()) {
    return refused(
        fmt::format("its leader '{:.64}' has no input '{:.64}'", gear.leader, gear.signal));
  }
  if (is_real(found->type) || found->bits < 8) {
    return refused(fmt::format("the input '{:.64}' of its leader is no integer of at least 8 bits",
                               gear.signal));
  }
  const auto follows_itself = [&](std::size_t axis) { return is_of(*found, known.axes[axis]); };
  if (std::ranges::any_of(axes, follows_itself)) return refused("an axis can't follow itself");
  const auto signal = static_cast<SignalIndex>(found - inputs.begin());
  motion::GearTask task{
      .kind = motion::LeaderKind::measured,
      .signal = static_cast<std::uint16_t>(signal),
      .bits = found->bits,
      .modulo = gear.modulo / std::abs(found->scale),
      .scale = found->scale,
      .zero = found->offset,
      .filter_time = gear.filter_time == 0.0 ? default_filter_time : gear.filter_time};
  const auto axis = std::ranges::find_if(
      known.axes, [&](const MotionAxis& each) { return is_position_of(*found, each); });
  if (axis != known.axes.end()) {
    task.leader_axis = static_cast<std::uint8_t>(axis - known.axes.begin());
    if (axis->position == signal && task.modulo == 0.0) task.modulo = axis->turn.length;
  }
  task.lead = cycles_of_lead * std::chrono::duration<double>{known.plan.cycle.period}.count();
  return task;
}

Task leader_of(const motion_gear_t& gear, std::span<const std::size_t> axes,
               const KnownAxes& known) {
  const auto node = node_of(known.plan, gear.leader);
  if (!node) return refused(fmt::format("its leader '{:.64}' is no node of the bus", gear.leader));
  if (!(gear.modulo >= 0.0) || std::isinf(gear.modulo)) {
    return refused("its modulo is negative, infinite or NaN");
  }
  if (!(gear.filter_time >= 0.0 && gear.filter_time <= longest_filter_time)) {
    return refused(fmt::format("its filter time is not between 0 and {} s", longest_filter_time));
  }
  if (gear.signal.empty()) return commanded_leader(gear, *node, axes, known);
  return measured_leader(gear, *node, axes, known);
}

}  // namespace

std::expected<std::vector<motion::GearTask>, MotionRefusal> gear_tasks(
    const motion_gear_t& gear, std::span<const std::size_t> axes, const KnownAxes& known) {
  const auto leader = leader_of(gear, axes, known);
  if (!leader) return std::unexpected{leader.error()};
  if (!gear.phase.empty() && gear.phase != "here" && gear.phase != "at") {
    return std::unexpected{MotionRefusal{.why = "its phase is neither \"here\" nor \"at\""}};
  }
  std::vector<motion::GearTask> tasks;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double divisor = gear.denominator[i] == 0.0 ? 1.0 : gear.denominator[i];
    const double ratio = gear.numerator[i] / divisor;
    if (!(std::abs(ratio) <= largest_ratio)) {
      return std::unexpected{
          MotionRefusal{.why = "its ratio is infinite, NaN or too large", .axis = axes[i]}};
    }
    const double most = gear.max_phase_error[i];
    if (!(most >= 0.0)) {
      return std::unexpected{
          MotionRefusal{.why = "its largest phase error is negative or NaN", .axis = axes[i]}};
    }
    motion::GearTask task = *leader;
    const Signal& target = known.plan.layout.signals[known.axes[axes[i]].target];
    task.match = gear.phase == "at" ? motion::PhaseMatch::at : motion::PhaseMatch::here;
    task.ratio = ratio;
    task.offset = gear.goals[i].position;
    task.lock_window = std::abs(target.scale);
    if (task.kind == motion::LeaderKind::measured) {
      task.lock_window = std::max(task.lock_window, std::abs(ratio * task.scale));
    }
    task.max_phase_error = most == 0.0 ? std::numeric_limits<double>::infinity() : most;
    task.range = known.limits.range(axes[i]);
    task.turn = known.limits.turn(axes[i]);
    tasks.push_back(task);
  }
  return tasks;
}

}  // namespace takt
