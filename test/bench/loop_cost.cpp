// Measures what one cycle of the bus loop costs, without the port.
//
//   loop_cost NODES [--receive-path] [--recorded]
//       prints one line: system calls and allocations per cycle
//   valgrind --tool=callgrind --collect-atstart=no loop_cost ...
//       collects 100 steady cycles; with --receive-path only the path from the return of receive()
//       to the published image
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>
#include <valgrind/callgrind.h>

#include "master/rt/bus_loop.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/recorded_port.hpp"
#include "test/bench/eight_u8.hpp"
#include "test/bench/memory_port.hpp"
#include "test/proof/allocation_trap.hpp"

namespace {

using namespace takt;

bool collecting = false;

bool path_only = false;  // collect only from the return of receive() until the image is published
int clock_reads = 0;     // readings of the clock that remain until the image is published

struct PauseCallgrind {
  [[gnu::always_inline]] void enter() noexcept {
    if (collecting && !path_only) CALLGRIND_TOGGLE_COLLECT;
  }
  [[gnu::always_inline]] void leave() noexcept {
    if (collecting && !path_only) CALLGRIND_TOGGLE_COLLECT;
  }
  [[gnu::always_inline]] void on_received() noexcept {
    if (!collecting || !path_only) return;
    clock_reads = 2;  // one for the time of the image, one for the next phase
    CALLGRIND_TOGGLE_COLLECT;
  }
  [[gnu::always_inline]] void on_now() noexcept {
    if (clock_reads != 0 && --clock_reads == 0) CALLGRIND_TOGGLE_COLLECT;
  }
};

using Memory = bench::MemoryPort<PauseCallgrind>;

/// `P` and `L` are the port in memory and the direct link, or the port and the link that record.
template <class P, class L>
class Bench {
 public:
  Bench(unsigned nodes, bool rpdos)
      // At this bit rate, 120 nodes fit into one cycle with one round of services.
      : plan_{bench::eight_u8({.nodes = nodes,
                               .rpdos = rpdos,
                               .period = std::chrono::milliseconds{40},
                               .bitrate = 10'000'000})},
        port{nodes},
        exchange_{std::make_unique<Exchange>(plan_)},
        loop_{std::make_unique<BusLoop<P, L>>(plan_, used(), link())} {
    loop_->start();
    run(20);  // heartbeats: every node is OPERATIONAL
    port.alive = true;
    run(50);  // the loop learns when the PDOs arrive
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      for (std::size_t o = 0; o < plan_.layout.outputs(); ++o) exchange_->set_points.set(o, i);
      exchange_->set_points.publish(port.now());
      const std::uint64_t before = port.calls;
      if (count) proof::count_allocations(true);
      if (collect) {
        collecting = true;
        if (!path_only) CALLGRIND_TOGGLE_COLLECT;
      }
      loop_->cycle();
      if (collect) {
        if (!path_only) CALLGRIND_TOGGLE_COLLECT;
        collecting = false;
      }
      proof::count_allocations(false);
      most_calls = std::max(most_calls, port.calls - before);
      ImageView image;
      while (exchange_->images.take(image)) {
      }
    }
  }

 private:
  P& used() {
    if constexpr (std::is_same_v<P, Memory>) {
      return port;
    } else {
      return recorded_;
    }
  }

  L link() {
    if constexpr (std::is_same_v<L, DirectLink>) {
      return *exchange_;
    } else {
      return {*exchange_, &journal_};
    }
  }

  BusPlan plan_;
  Journal journal_{16 << 20};

 public:
  Memory port;
  bool collect = false;
  bool count = false;
  std::uint64_t most_calls = 0;

 private:
  RecordedPort<Memory> recorded_{port, &journal_};
  std::unique_ptr<Exchange> exchange_;
  std::unique_ptr<BusLoop<P, L>> loop_;
};

template <class P, class L>
void measure(unsigned nodes) {
  Bench<P, L> bench{nodes, !path_only};
  constexpr int cycles = 100;

  bench.collect = bench.count = true;
  bench.most_calls = 0;
  const std::uint64_t before = bench.port.calls;
  bench.run(cycles);
  const double calls = static_cast<double>(bench.port.calls - before) / cycles;
  bench.collect = false;

  bench.most_calls = 0;
  bench.port.silent = 1;
  bench.run(cycles);
  std::printf(
      "%u nodes: %.2f system calls a cycle, at most %llu with a missing PDO, %.2f allocations\n",
      nodes, calls, static_cast<unsigned long long>(bench.most_calls),
      static_cast<double>(proof::allocations()) / cycles);
}

}  // namespace

int main(int argc, char** argv) {
  const auto nodes = static_cast<unsigned>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 8);
  if (nodes < 1 || nodes > 127) return 2;
  bool recorded = false;
  for (const std::string_view argument : std::span{argv, static_cast<std::size_t>(argc)}) {
    path_only |= argument == "--receive-path";
    recorded |= argument == "--recorded";
  }
  recorded ? measure<RecordedPort<Memory>, RecordedLink>(nodes)
           : measure<Memory, DirectLink>(nodes);
  return 0;
}
