// Nanoseconds of processor time that the motions of 120 axes take in one beat: while all move,
// while all follow streams or leaders, and in the beat in which all stop.
#include <array>
#include <benchmark/benchmark.h>
#include <vector>

#include "master/motion/beat/axis_motions.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::motion {
namespace {

constexpr std::size_t axes = 120;
constexpr double period = 0.001;
constexpr Limits limits{.max_velocity = 1.0,
                        .min_velocity = -1.0,
                        .max_acceleration = 5.0,
                        .min_acceleration = -5.0,
                        .jerk = 50.0};

/// All axes of one group in the middle of their motions.
struct MovingAxes {
  MovingAxes() : motions{axes, period}, inputs(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
    run();
    std::vector<AxisTask> tasks(axes);
    for (AxisTask& task : tasks) task = {.from = {}, .to = {.position = 1e6}, .limits = limits};
    std::vector<PlannedAxis> planned(axes);
    if (!plan_trajectory(tasks, {}, planned)) return;
    for (std::size_t i = 0; i < axes; ++i) {
      MotionOrder order;
      order.id = 1;
      order.axis = static_cast<std::uint8_t>(i);
      order.axes = axes;
      order.begin = cycle + 1;
      order.profile = planned[i].profile;
      order.stop = limits;
      order.timeout = 1'000'000'000;
      motions.take(order);
    }
    for (int i = 0; i < 100; ++i) run();
  }

  std::span<const AxisReport> run() {
    ++cycle;
    return motions.run(cycle, inputs);
  }

  AxisMotions motions;
  std::vector<AxisInput> inputs;
  CycleNumber cycle = 0;
};

void moving(benchmark::State& state) {
  MovingAxes moving;
  for (auto _ : state) {
    const auto reports = moving.run();
    for (std::size_t i = 0; i < axes; ++i) moving.inputs[i].actual = reports[i].commanded;
  }
}
BENCHMARK(moving)->Unit(benchmark::kMicrosecond);

/// All axes follow streams, which get a point in each 20th beat.
struct StreamingAxes {
  static constexpr CycleNumber step = 20;

  StreamingAxes() : motions{axes, period}, inputs(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
    motions.run(++cycle, inputs);
    for (std::size_t i = 0; i < axes; ++i) {
      MotionOrder order;
      order.id = 1;
      order.axis = static_cast<std::uint8_t>(i);
      order.axes = axes;
      order.ending = Ending::points;
      order.begin = cycle + 1;
      order.stop = limits;
      order.timeout = 1'000'000'000;
      motions.take(order);
    }
    for (int i = 0; i < 10; ++i) add();
  }

  /// The next point of all axes, each of which moves at the same velocity.
  void add() {
    StreamPoints next{.order = 1, .size = 1};
    const double time = static_cast<double>(++points * step) * period;
    next.points[0] = {.time = time, .state = {.position = 0.1 * time, .velocity = 0.1}};
    for (std::size_t i = 0; i < axes; ++i) motions.add_points(static_cast<std::uint8_t>(i), next);
  }
  std::span<const AxisReport> run() {
    if (++cycle % step == 0) add();
    return motions.run(cycle, inputs);
  }

  AxisMotions motions;
  std::vector<AxisInput> inputs;
  CycleNumber cycle = 0;
  CycleNumber points = 0;
};

void streaming(benchmark::State& state) {
  StreamingAxes streaming;
  for (auto _ : state) {
    const auto reports = streaming.run();
    for (std::size_t i = 0; i < axes; ++i) streaming.inputs[i].actual = reports[i].commanded;
  }
}
BENCHMARK(streaming)->Unit(benchmark::kMicrosecond);

/// All axes follow measured leaders. The counters of the leaders advance at a constant velocity,
/// with a noise of some counts.
struct GearedAxes {
  GearedAxes() : motions{axes, period}, inputs(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
    run();
    for (std::size_t i = 0; i < axes; ++i) {
      MotionOrder order;
      order.id = 1;
      order.axis = order.group = static_cast<std::uint8_t>(i);
      order.ending = Ending::gear;
      order.begin = cycle + 1;
      order.stop = limits;
      order.timeout = 1'000'000'000;
      order.gear = {.kind = LeaderKind::measured,
                    .match = PhaseMatch::at,
                    .scale = 1e-4,
                    .filter_time = 0.02,
                    .lock_window = 1e-3};
      motions.take(order);
    }
    for (int i = 0; i < 2000; ++i) run();
  }

  std::span<const AxisReport> run() {
    ++cycle;
    const auto counts = static_cast<std::int64_t>(3 * cycle + cycle * 7919 % 5);
    for (AxisInput& input : inputs) {
      input.leaders[0] = {.signal = 0, .age = LeaderSample::Age::fresh, .counts = counts};
    }
    return motions.run(cycle, inputs);
  }

  AxisMotions motions;
  std::vector<AxisInput> inputs;
  CycleNumber cycle = 0;
};

void geared(benchmark::State& state) {
  GearedAxes geared;
  for (auto _ : state) {
    const auto reports = geared.run();
    for (std::size_t i = 0; i < axes; ++i) geared.inputs[i].actual = reports[i].commanded;
  }
}
BENCHMARK(geared)->Unit(benchmark::kMicrosecond);

void all_stop(benchmark::State& state) {
  const MovingAxes moving;
  for (auto _ : state) {
    state.PauseTiming();
    MovingAxes copy = moving;
    state.ResumeTiming();
    copy.motions.stop_axis(0, StopCause::application);
    benchmark::DoNotOptimize(copy.run().data());
  }
}
BENCHMARK(all_stop)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace takt::motion

BENCHMARK_MAIN();
