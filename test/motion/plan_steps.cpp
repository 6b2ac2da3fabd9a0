// plan_steps [TASKS] - counts the calls of functions that planning one axis makes, over random
// tasks of all classes, and fails if a task needs more than the bound of share/doc/trajectory.md.
// The planner is compiled with -finstrument-functions, so that its loops need no counters.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "test/unit/master/motion/random_tasks.hpp"

namespace {

std::uint64_t calls = 0;

}  // namespace

extern "C" {
void __cyg_profile_func_enter(void*, void*);
void __cyg_profile_func_exit(void*, void*);
void __cyg_profile_func_enter(void*, void*) { ++calls; }
void __cyg_profile_func_exit(void*, void*) {}
}

namespace takt::motion {
namespace {

constexpr std::uint64_t bound = 2'000;

std::uint64_t calls_of(const AxisTask& task, double duration) {
  PlannedAxis planned;
  calls = 0;
  [[maybe_unused]] const auto done =
      plan_trajectory({&task, 1}, {.minimum_duration = duration}, std::span{&planned, 1});
  return calls;
}

int run(int tasks) {
  std::uint64_t most = 0;
  for (int which = 0; which <= task_classes; ++which) {
    RandomTasks random{static_cast<std::uint64_t>(which)};
    std::uint64_t sum = 0;
    std::uint64_t most_here = 0;
    for (int i = 0; i < tasks; ++i) {
      const AxisTask task = random.next(static_cast<TaskClass>(which));
      const std::uint64_t shortest = calls_of(task, 0.0);
      const std::uint64_t longer = calls_of(task, 10.0);  // longer than most tasks need
      sum += shortest;
      most_here = std::max({most_here, shortest, longer});
    }
    std::printf("class %d: %.0f calls on average, at most %llu\n", which,
                static_cast<double>(sum) / tasks, static_cast<unsigned long long>(most_here));
    most = std::max(most, most_here);
  }
  if (most <= bound) return 0;
  std::printf("FAILED: more than %llu calls\n", static_cast<unsigned long long>(bound));
  return 1;
}

}  // namespace
}  // namespace takt::motion

int main(int count, char** words) {
  return takt::motion::run(count > 1 ? std::atoi(words[1]) : 20'000);
}
