// Nanoseconds of processor time for the shortest motion of one axis, in eight classes of random
// tasks.
#include <benchmark/benchmark.h>
#include <vector>

#include "test/unit/master/motion/random_tasks.hpp"

namespace takt::motion {
namespace {

void plan_axis(benchmark::State& state) {
  RandomTasks random{1};
  std::vector<AxisTask> tasks;
  for (int i = 0; i < 10'000; ++i) {
    tasks.push_back(random.next(static_cast<TaskClass>(state.range(0))));
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const AxisTask& task = tasks[next++ % tasks.size()];
    const AxisMotion motion{task.from, task.to, task.limits, Goal::position};
    benchmark::DoNotOptimize(motion.profile(motion.possible(0.0)));
  }
}
BENCHMARK(plan_axis)->DenseRange(0, task_classes - 1);

}  // namespace
}  // namespace takt::motion

BENCHMARK_MAIN();
