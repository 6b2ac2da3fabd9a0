#include "apps/takt/soak/judge/motion/group_judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr double cruise_cycles = 8;  // number of cycles in which the velocity is measured
constexpr double least_way = 50;     // counts; an axis with a shorter way is not watched
// Number of cycles after which an axis that has not moved has not begun.
constexpr unsigned late_cycles = 10;

double seconds(Time time) noexcept { return std::chrono::duration<double>(time).count(); }

Time from_seconds(double time) noexcept {
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>{time});
}

/// Returns the time from the begin of a motion until its velocity is reached.
double rise(const MotionBounds& bounds) noexcept {
  return bounds.velocity / bounds.acceleration + bounds.acceleration / bounds.jerk;
}

/// Returns the latest time from the begin of a motion until its first count.
double first_count(const MotionBounds& bounds) noexcept { return std::cbrt(6 / bounds.jerk); }

}  // namespace

void GroupJudge::watch(const std::vector<Member>& members) {
  Group group;
  for (const Member& member : members) {
    const MotionBounds& bounds = member.bounds;
    const bool has_shape =
        bounds.velocity * bounds.jerk >= bounds.acceleration * bounds.acceleration;
    if (!has_shape || std::abs(member.target - member.from) < least_way) return;
    group.axes.push_back({.member = member, .value = member.from});
  }
  groups_.push_back(std::move(group));
}

void GroupJudge::forget(std::size_t axis) {
  std::erase_if(groups_, [&](const Group& group) {
    return std::ranges::any_of(group.axes,
                               [&](const Begin& one) { return one.member.axis == axis; });
  });
}

/// Finds the time at which the axis has begun. An axis that has reached its velocity is where it
/// would be if its velocity had jumped to this value in the middle of the acceleration.
void GroupJudge::look(Begin& axis, Group& group, double value, Time now) const {
  axis.value = value;
  const MotionBounds& bounds = axis.member.bounds;
  const double way = std::abs(value - axis.member.from);
  const double all = std::abs(axis.member.target - axis.member.from);
  const double rise_way = bounds.velocity * rise(bounds) / 2 + 2;
  if (axis.begun || way < rise_way) return;
  if (way > all - rise_way) {
    group.over = !axis.begun;
    return;
  }
  if (!axis.cruises_at) {
    axis.cruises_at = way;
    axis.cruises_since = now;
    return;
  }
  const double measured = way - *axis.cruises_at;
  if (measured < bounds.velocity * seconds(plan_.cycle.period) * cruise_cycles) return;
  const double expected = bounds.velocity * seconds(now - axis.cruises_since);
  const double tolerance = 0.5 * bounds.velocity * seconds(plan_.cycle.period) + 2;
  if (std::abs(measured - expected) > tolerance) {
    group.over = true;  // the group is stopping
  } else {
    axis.begun = now - from_seconds(way / bounds.velocity + rise(bounds) / 2);
  }
}

void GroupJudge::sent(std::size_t axis, double value, Time now) {
  for (Group& group : groups_) {
    for (Begin& one : group.axes) {
      if (one.member.axis == axis) look(one, group, value, now);
    }
    judge(group, now);
  }
  std::erase_if(groups_, [](const Group& group) { return group.over; });
}

void GroupJudge::judge(Group& group, Time now) {
  if (group.over) return;
  const auto first =
      std::ranges::find_if(group.axes, [](const Begin& axis) { return axis.begun.has_value(); });
  if (first == group.axes.end()) return;
  bool all = true;
  for (const Begin& axis : group.axes) {
    const Time late =
        from_seconds(first_count(axis.member.bounds)) + late_cycles * plan_.cycle.period;
    const bool stands = axis.value == axis.member.from && now > *first->begun + late;
    all = all && axis.begun;
    if (!axis.begun && !stands) continue;
    const Time apart = axis.begun ? *axis.begun - *first->begun : now - *first->begun;
    if (!stands && std::chrono::abs(apart) <= plan_.cycle.period * 6 / 10) continue;
    verdict_.report_violation(
        "a group begins in one cycle",
        fmt::format("axis {} {} {} us after axis {}", axis.member.axis,
                    stands ? "has not begun" : "has begun", apart / 1us, first->member.axis));
  }
  if (!all) return;
  ++judged_;
  group.over = true;
}

}  // namespace takt::soak
