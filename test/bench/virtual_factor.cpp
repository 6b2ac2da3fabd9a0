// How much faster than real time a whole bus runs in virtual time: 8 axes at 4 ms, one TPDO and one
// RPDO of 6 bytes each; seconds of the bus per second of processor time.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "test/virtual/rig.hpp"

int main(int argc, char** argv) {
  using namespace takt;
  const int cycles = argc > 1 ? std::atoi(argv[1]) : 50'000;
  test::Rig rig{
      test::axes({.nodes = 8, .period = std::chrono::milliseconds{4}, .fallback_cycles = 10})};
  if (!rig.boot()) return 1;
  rig.recorder.keep = false;
  const std::clock_t begin = std::clock();
  for (int i = 0; i < cycles; ++i) {
    rig.command_all(0x000F, i);
    rig.cycle();
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("8 axes at 4 ms, PDOs of 6 bytes: %.0f times real time\n", cycles * 0.004 / seconds);
  return 0;
}
