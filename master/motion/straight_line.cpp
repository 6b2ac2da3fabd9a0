#include "master/motion/straight_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace takt::motion {
namespace {

double way(const AxisTask& task) { return task.to.position - task.from.position; }
double start_velocity(const AxisTask& task) { return task.from.velocity; }
double start_acceleration(const AxisTask& task) { return task.from.acceleration; }
double end_velocity(const AxisTask& task) { return task.to.velocity; }
double end_acceleration(const AxisTask& task) { return task.to.acceleration; }

/// The largest deviation of a quantity from the direction of the line, relative to the largest
/// value of this quantity on all axes.
constexpr double line_tolerance = 1e-12;

double largest(std::span<const AxisTask> tasks, double (*quantity)(const AxisTask&)) noexcept {
  double size = 0.0;
  for (const AxisTask& task : tasks) size = std::max(size, std::abs(quantity(task)));
  return size;
}

/// Reduces `all`, the range of the leader, so that the axis of `task`, which makes this share of
/// the leader's motion, stays inside its own range.
void restrict(PositionRange& all, const AxisTask& leader, const AxisTask& task,
              double share) noexcept {
  if (share == 0.0) return;
  const auto of_leader = [&](double position) {
    return leader.from.position + (position - task.from.position) / share;
  };
  const double a = of_leader(task.range.min);
  const double b = of_leader(task.range.max);
  all.min = std::max(all.min, std::min(a, b));
  all.max = std::min(all.max, std::max(a, b));
}

/// Reduces `all`, the limits of the leader, so that an axis which makes this share of the leader's
/// motion stays inside its limits `own`.
void restrict(Limits& all, const Limits& own, double share) noexcept {
  if (share == 0.0) return;
  const Limits seen = share > 0.0 ? own : mirrored(own);
  const double size = std::abs(share);
  all.max_velocity = std::min(all.max_velocity, seen.max_velocity / size);
  all.min_velocity = std::max(all.min_velocity, seen.min_velocity / size);
  all.max_acceleration = std::min(all.max_acceleration, seen.max_acceleration / size);
  all.min_acceleration = std::max(all.min_acceleration, seen.min_acceleration / size);
  all.jerk = std::min(all.jerk, seen.jerk / size);
}

}  // namespace

std::optional<StraightLine> StraightLine::find(std::span<const AxisTask> tasks,
                                               Goal goal) noexcept {
  constexpr std::array quantities{way, start_velocity, start_acceleration, end_velocity,
                                  end_acceleration};
  const auto counted = std::span{quantities}.subspan(goal == Goal::position ? 0 : 1);
  const auto direction =
      std::ranges::find_if(counted, [&](auto quantity) { return largest(tasks, quantity) > 0.0; });
  if (direction == counted.end()) return std::nullopt;  // nothing moves
  const auto leader = std::ranges::max_element(
      tasks, {}, [&](const AxisTask& task) { return std::abs((*direction)(task)); });
  StraightLine line{*leader, *direction};
  for (const AxisTask& task : tasks) {
    for (const auto quantity : counted) {
      const double miss = quantity(task) - line.share(task) * quantity(*leader);
      if (std::abs(miss) > line_tolerance * largest(tasks, quantity)) return std::nullopt;
    }
    restrict(line.leader_.limits, task.limits, line.share(task));
    restrict(line.leader_.range, *leader, task, line.share(task));
  }
  return line;
}

double StraightLine::share(const AxisTask& task) const noexcept { return direction_(task) / size_; }

}  // namespace takt::motion
