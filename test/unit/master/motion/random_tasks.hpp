#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "master/motion/trajectory.hpp"

namespace takt::motion {

/// What is special about random tasks. Other motion planners fail for several of them.
enum class TaskClass : std::uint8_t {
  general,          ///< any states inside the limits
  rest_to_rest,     ///< from standstill to standstill
  to_rest,          ///< to no acceleration, half of them to standstill
  near_target,      ///< the start differs from the target by 1e-16 to 1e-10
  at_acceleration,  ///< accelerations at their limits
  at_velocity,      ///< velocities at their limits
  outside,          ///< the start is outside the limits
  round_numbers,    ///< multiples of one half, where cases meet
  wide_limits,      ///< limits that differ by many powers of ten; a double may have too few digits
};
/// Number of the classes in which each task has a motion: all but wide_limits.
inline constexpr int task_classes = 8;

/// Makes tasks from a seed.
class RandomTasks {
 public:
  explicit RandomTasks(std::uint64_t seed) : random_{seed} {}

  AxisTask next(TaskClass which) {
    AxisTask task;
    do task = attempt(which);
    while (!defect_of(task).has_value());
    return task;
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  double size(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance() { return random_() % 2 == 0; }
  double one_of(double a, double b) { return chance() ? a : b; }

  AxisTask attempt(TaskClass which) {
    AxisTask task;
    Limits& limits = task.limits;
    limits = {.max_velocity = size(0.1, 10.0),
              .min_velocity = -size(0.1, 10.0),
              .max_acceleration = size(0.1, 10.0),
              .min_acceleration = -size(0.1, 10.0),
              .jerk = size(0.1, 100.0)};
    if (chance()) limits.min_velocity = -limits.max_velocity;
    if (chance()) limits.min_acceleration = -limits.max_acceleration;
    const double range = size(1e-3, 100.0);
    const auto state = [&] {
      return State{.position = between(-range, range),
                   .velocity = between(limits.min_velocity, limits.max_velocity),
                   .acceleration = between(limits.min_acceleration, limits.max_acceleration)};
    };
    task.from = state();
    task.to = state();
    specialise(task, which);
    return task;
  }

  void specialise(AxisTask& task, TaskClass which) {
    const Limits& limits = task.limits;
    switch (which) {
      case TaskClass::general:
        break;
      case TaskClass::rest_to_rest:
        task.from = {.position = task.from.position};
        task.to = {.position = task.to.position};
        break;
      case TaskClass::to_rest:
        task.to.acceleration = 0.0;
        if (chance()) task.to.velocity = 0.0;
        break;
      case TaskClass::near_target:
        be_near_target(task);
        break;
      case TaskClass::at_acceleration:
        task.from.acceleration = one_of(limits.max_acceleration, limits.min_acceleration);
        if (chance()) {
          task.to.acceleration = one_of(limits.max_acceleration, limits.min_acceleration);
        }
        break;
      case TaskClass::at_velocity:
        if (chance()) task.from.velocity = one_of(limits.max_velocity, limits.min_velocity);
        task.to.velocity = one_of(limits.max_velocity, limits.min_velocity);
        task.to.acceleration = 0.0;
        break;
      case TaskClass::outside:
        task.from.velocity *= 3.0;
        task.from.acceleration *= 3.0;
        break;
      case TaskClass::round_numbers:
        be_round(task);
        break;
      case TaskClass::wide_limits:
        be_wide(task);
        break;
    }
  }

  void be_near_target(AxisTask& task) {
    const double difference = size(1e-16, 1e-10);
    if (chance()) task.to.velocity = 0.0;
    if (chance()) task.to.acceleration = 0.0;
    task.from = task.to;
    if (chance()) task.from.position += between(-difference, difference);
    if (chance()) task.from.velocity += between(-difference, difference);
    if (chance()) task.from.acceleration += between(-difference, difference);
  }

  void be_wide(AxisTask& task) {
    Limits& limits = task.limits;
    const auto wide = [&] { return size(1e-9, 1e9); };
    limits = {.max_velocity = wide(),
              .min_velocity = -wide(),
              .max_acceleration = wide(),
              .min_acceleration = -wide(),
              .jerk = wide()};
    if (chance()) limits.min_velocity = -limits.max_velocity;
    if (chance()) limits.min_acceleration = -limits.max_acceleration;
    const double range = wide();
    for (State* state : {&task.from, &task.to}) {
      *state = {.position = between(-range, range)};
      if (chance()) state->velocity = between(limits.min_velocity, limits.max_velocity);
      if (random_() % 4 == 0) {
        state->acceleration = between(limits.min_acceleration, limits.max_acceleration);
      }
    }
  }

  static void be_round(AxisTask& task) {
    for (State* state : {&task.from, &task.to}) {
      *state = {.position = std::round(state->position * 2.0) / 2.0,
                .velocity = std::round(state->velocity * 2.0) / 2.0,
                .acceleration = std::round(state->acceleration * 2.0) / 2.0};
    }
    Limits& limits = task.limits;
    limits = {.max_velocity = std::ceil(limits.max_velocity),
              .min_velocity = std::floor(limits.min_velocity),
              .max_acceleration = std::ceil(limits.max_acceleration),
              .min_acceleration = std::floor(limits.min_acceleration),
              .jerk = std::ceil(limits.jerk)};
  }

  std::mt19937_64 random_;
};

}  // namespace takt::motion
