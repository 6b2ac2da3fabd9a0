// How much faster than real time a whole bus runs in virtual time: seconds of the bus per second of
// processor time, with 8 axes at 4 ms and one TPDO and one RPDO each.
//
//   virtual_factor [CYCLES]    the bus loop alone, with PDOs of 6 bytes and devices that return
//       what they receive, and `takt simulate --move` of eight_axes.yaml: CiA 402 axes that follow
//       new set-points in each cycle, with PDOs of 8 bytes; and the same axes with all parts of
//       mechanics, moved by a program over the whole taktd (`takt simulate --applications 1`)
//   virtual_factor CYCLES servos    only the last of them, for callgrind
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "apps/takt/simulate/front_simulation.hpp"
#include "apps/takt/simulate/simulation.hpp"
#include "test/virtual/rig.hpp"

namespace {

using namespace takt;

constexpr Time period = std::chrono::milliseconds{4};

void report(const char* what, Time simulated, std::clock_t begin) {
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%s: %.0f times real time\n", what,
              std::chrono::duration<double>(simulated).count() / seconds);
}

bool run_loop(int cycles) {
  test::Rig rig{test::axes({.nodes = 8, .period = period, .fallback_cycles = 10})};
  if (!rig.boot()) return false;
  rig.recorder.keep = false;
  const std::clock_t begin = std::clock();
  for (int i = 0; i < cycles; ++i) {
    rig.command_all(0x000F, i);
    rig.cycle();
  }
  report("8 axes at 4 ms, PDOs of 6 bytes", cycles * period, begin);
  return true;
}

bool run_drives(int cycles) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/test/bench/eight_axes.yaml");
  if (has_error(network.findings)) return false;
  const std::clock_t begin = std::clock();
  const SimulationOutcome outcome = simulate(network, {.duration = cycles * period, .move = true});
  report("8 CiA 402 axes at 4 ms that move, PDOs of 8 bytes", outcome.simulated, begin);
  return outcome.axes_moved == 8;
}

bool run_servos(int cycles) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/test/bench/eight_servos.yaml");
  if (has_error(network.findings)) return false;
  const std::clock_t begin = std::clock();
  const SimulationOutcome outcome =
      simulate_front(network, {.duration = cycles * period, .applications = 1});
  report("8 CiA 402 axes at 4 ms with mechanics, with the front thread", outcome.simulated, begin);
  return outcome.axes_moved == 8;
}

}  // namespace

int main(int argc, char** argv) {
  const int cycles = argc > 1 ? std::atoi(argv[1]) : 50'000;
  if (argc > 2 && std::string_view{argv[2]} == "servos") return run_servos(cycles) ? 0 : 1;
  return run_loop(cycles) && run_drives(cycles) && run_servos(cycles) ? 0 : 1;
}
