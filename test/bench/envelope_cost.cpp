// Measures in nanoseconds the cost of the envelope of a command of eight outputs, for the sender
// and for the daemon.
#include <benchmark/benchmark.h>
#include <chrono>
#include <vector>

#include "master/lcm/envelope/envelope.hpp"

namespace takt {
namespace {

constexpr Time wall = std::chrono::seconds{1'700'000'000};
const std::vector<std::byte> command(180);

void seal_command(benchmark::State& state) {
  EnvelopeSeal seal{{.name = "plant"}, 1};
  for (auto _ : state) benchmark::DoNotOptimize(seal.seal("LIFT_COMMAND", command, 42, wall));
}
BENCHMARK(seal_command);

void seal_and_open_command(benchmark::State& state) {
  EnvelopeSeal seal{{.name = "plant"}, 1};
  EnvelopeGuard guard{42};
  guard.set_keys({{.name = "plant"}});
  for (auto _ : state) {
    auto opened = guard.open(seal.seal("LIFT_COMMAND", command, 42, wall), wall);
    if (!opened) state.SkipWithError("refused");
    benchmark::DoNotOptimize(opened);
  }
}
BENCHMARK(seal_and_open_command);

}  // namespace
}  // namespace takt

BENCHMARK_MAIN();
