// Nanoseconds for one PDO of eight UNSIGNED8, in memory.
#include <benchmark/benchmark.h>
#include <memory>
#include <vector>

#include "master/core/pdo/pdo_exchange.hpp"
#include "test/bench/eight_u8.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

const Frame frame = make_frame(CobId::base(0x181), {1, 2, 3, 4, 5, 6, 7, 8});

/// Measures only the copy of the eight values from the frame.
void unpack_pdo(benchmark::State& state) {
  const BusPlan plan = bench::eight_u8({});
  std::vector<FieldProgram> fields;
  for (const PdoField& field : plan.pdos.fields) fields.push_back(compile(field));
  fields.resize(8);
  std::vector<std::int64_t> image(plan.layout.signals.size());
  Frame in = frame;
  for (auto _ : state) {
    benchmark::DoNotOptimize(in);
    unpack(load(in), fields, image.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(unpack_pdo);

/// Measures the whole reception: look-up by COB-ID, length, expected set, time stamp, values.
void receive_pdo(benchmark::State& state) {
  const BusPlan plan = bench::eight_u8({});
  const auto events = std::make_unique<EventQueue>();
  PdoExchange pdos{plan, *events};
  pdos.inputs().set_reception(0, Reception::full);
  pdos.inputs().begin(1, 1ms);
  StampedFrame stamped{.frame = frame, .when = 2ms};
  for (auto _ : state) {
    benchmark::DoNotOptimize(stamped);
    benchmark::DoNotOptimize(pdos.inputs().receive(stamped));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(receive_pdo);

/// Measures the sending: freshness, time to live, values, frame. Each of the 32 RPDOs has a new
/// command every time.
void send_pdo(benchmark::State& state) {
  constexpr std::int64_t nodes = 32;
  const BusPlan plan = bench::eight_u8({.nodes = nodes});
  const auto events = std::make_unique<EventQueue>();
  PdoExchange pdos{plan, *events};
  std::vector<SetPoint> points(plan.layout.outputs());
  for (std::size_t i = 0; i < nodes; ++i) pdos.outputs().open(i, points);
  OutputMoment moment;
  for (auto _ : state) {
    ++moment.cycle;
    moment.now += 1ms;
    for (SetPoint& point : points) {
      ++point.generation;
      point.when = moment.now;
    }
    const auto frames = pdos.outputs().pack(points, moment);
    benchmark::DoNotOptimize(frames.data());
    pdos.outputs().sent(frames.size(), moment);
    benchmark::ClobberMemory();
  }
  state.counters["ns_per_pdo"] =
      benchmark::Counter(static_cast<double>(state.iterations() * nodes) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(send_pdo);

}  // namespace
}  // namespace takt

BENCHMARK_MAIN();
