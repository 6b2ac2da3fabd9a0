// Measures in microseconds how late the bus loop hands SYNC to the socket. A bare clock_nanosleep
// loop, which sends one frame and discards what it receives, is measured in turns with it: on the
// same thread, with the same kind of socket and the same devices.
//
//   sync_lateness [BLOCKS [CYCLES]]     5 blocks of 1000 cycles of 1 ms for each of the four
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "master/linux/rt_thread.hpp"
#include "master/linux/unix_bus/unix_bus.hpp"
#include "master/rt/bus_loop.hpp"
#include "test/bench/eight_u8.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr unsigned nodes = 8;
constexpr Time period = 1ms;

/// Eight devices that answer SYNC.
class Devices {
 public:
  explicit Devices(UnixBusPort& port) : thread_{[this, &port] { run(port); }} {}
  ~Devices() {
    done_ = true;
    thread_.join();
  }

 private:
  void run(UnixBusPort& port) {
    std::vector<StampedFrame> in(256);
    std::vector<Frame> answers;
    for (std::uint32_t node = 1; node <= nodes; ++node) {
      answers.push_back(make_frame(CobId::base(0x700 + node), {5}));
      answers.push_back(make_frame(CobId::base(0x180 + node), {1, 2, 3, 4, 5, 6, 7, 8}));
    }
    while (!done_) {
      port.wait_frame(port.now() + 5ms);
      const std::size_t count = port.receive(in);
      for (std::size_t i = 0; i < count; ++i) {
        if (in[i].frame.id == CobId::base(0x080)) port.send(answers);
      }
    }
  }
  std::atomic<bool> done_{false};
  std::thread thread_;
};

void bare_block(int cycles, Time spin, Histogram& lateness) {
  auto [port, other] = make_socket_pair_bus({}, spin);
  const Devices devices{other};
  std::vector<StampedFrame> in(64);
  const Frame sync{.id = CobId::base(0x080)};
  Time deadline = port.now();
  for (int i = 0; i < cycles; ++i) {
    deadline += period;
    port.sleep_precisely_until(deadline);
    lateness.record(port.now() - deadline);
    port.send({&sync, 1});
    while (port.receive(in) == in.size()) {
    }
  }
}

void master_block(int cycles, Time spin, Histogram& lateness) {
  auto [port, other] = make_socket_pair_bus(CobId::base(0x080), spin);
  const BusPlan plan = bench::eight_u8({.nodes = nodes, .period = period});
  const auto exchange = std::make_unique<Exchange>(plan);
  const auto loop = std::make_unique<BusLoop<UnixBusPort>>(plan, port, *exchange);
  const Devices devices{other};
  loop->start();
  for (int i = 0; i < 100; ++i) loop->cycle();
  const HistogramSnapshot before = exchange->timing.sync_lateness.snapshot();
  for (int i = 0; i < cycles; ++i) {
    for (std::size_t o = 0; o < plan.layout.outputs(); ++o) exchange->set_points.set(o, i);
    exchange->set_points.publish(port.now());
    loop->cycle();
    ImageView image;
    while (exchange->images.take(image)) {
    }
  }
  const HistogramSnapshot run = exchange->timing.sync_lateness.snapshot() - before;
  for (std::size_t bin = 0; bin < run.bins; ++bin) {
    for (std::uint64_t n = 0; n < run.counts[bin]; ++n) {
      lateness.record(Histogram::upper_edge(bin) - 1ns);
    }
  }
}

void print(const char* name, Time spin, const Histogram& lateness) {
  const HistogramSnapshot all = lateness.snapshot();
  const auto us = [&](double p) { return static_cast<double>(all.percentile(p).count()) / 1000; };
  std::printf("%s spin %3lld us: median %.1f us, p99 %.1f us (%llu cycles)\n", name,
              static_cast<long long>(spin / 1us), us(0.5), us(0.99),
              static_cast<unsigned long long>(all.total()));
}

}  // namespace

int main(int argc, char** argv) {
  const int blocks = argc > 1 ? std::atoi(argv[1]) : 5;
  const int cycles = argc > 2 ? std::atoi(argv[2]) : 1000;
  std::thread measuring{[&] {
    const RtReport report = apply_realtime({});
    std::fprintf(stderr, "%s\n", to_string(report).c_str());
    for (const Time spin : {Time{0}, Time{100us}}) {
      const auto bare = std::make_unique<Histogram>();
      const auto master = std::make_unique<Histogram>();
      for (int block = 0; block < blocks; ++block) {
        bare_block(cycles, spin, *bare);
        master_block(cycles, spin, *master);
      }
      print("bare loop", spin, *bare);
      print("takt     ", spin, *master);
    }
  }};
  measuring.join();
  return 0;
}
