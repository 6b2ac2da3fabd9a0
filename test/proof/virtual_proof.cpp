// Runs the whole master on the simulated bus: 100,000 cycles after the boot of 32 nodes, with
// heartbeats, SDO requests, and a node that is switched off and on. The master may not allocate or
// free memory.
//
//   virtual_proof [CYCLES]     exit code 0; 97 and a report if something is allocated or freed
#include <cstdio>
#include <cstdlib>

#include "test/proof/allocation_trap.hpp"
#include "test/virtual/rig.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr unsigned nodes = 32;

/// The port of the simulation. The trap is off inside the port, because the simulated devices may
/// allocate.
class ForwardingPort {
  template <class F>
  auto free_for_all(F&& act) noexcept {
    struct Pause {
      explicit Pause(bool on) : armed{on} { proof::trap_allocations(false); }
      ~Pause() { proof::trap_allocations(armed); }
      bool armed;
    } pause{armed};
    return act();
  }

 public:
  explicit ForwardingPort(sim::SimPort& port) : port_{port} {}

  Time now() noexcept { return port_.now(); }
  void sleep_until(Time until) noexcept {
    free_for_all([&] { port_.sleep_until(until); });
  }
  void sleep_precisely_until(Time until) noexcept {
    free_for_all([&] { port_.sleep_precisely_until(until); });
  }
  bool wait_frame(Time until) noexcept {
    return free_for_all([&] { return port_.wait_frame(until); });
  }
  std::size_t receive(std::span<StampedFrame> in) noexcept { return port_.receive(in); }
  SendResult send(std::span<const Frame> out) noexcept { return port_.send(out); }
  PortCondition condition() const noexcept { return port_.condition(); }

  bool armed = false;  ///< the trap is on outside the port

 private:
  sim::SimPort& port_;
};

/// Runs one cycle, in which nothing may be allocated or freed.
void trapped_cycle(MasterRun& master, ForwardingPort& port) {
  port.armed = true;
  proof::trap_allocations(true);
  master.cycle();
  proof::trap_allocations(false);
  port.armed = false;
}

Request upload(std::uint64_t id) {
  Request request;
  request.id = id;
  request.node = static_cast<std::uint8_t>(id % nodes + 1);
  request.object = {0x1018, 1};
  return request;
}

int prove(std::uint64_t cycles) {
  test::Rig rig{test::axes({.nodes = nodes, .period = 10ms, .fallback_cycles = 0})};
  ForwardingPort port{*rig.port};
  rig.use(port);
  if (!rig.boot()) {
    std::fprintf(stderr, "virtual_proof: the nodes do not boot\n");
    return 1;
  }
  rig.recorder.keep = false;
  rig.command_all(0x000F, 5);
  std::uint64_t images = 0;
  std::uint64_t replies = 0;
  std::uint64_t requests = 0;
  MasterRun& master = *rig.master;
  for (std::uint64_t i = 0; i < cycles; ++i) {
    if (i % 100 == 0) requests += master.submit(upload(i));
    if (i == cycles / 2) rig.world->power(7_node, false);
    if (i == cycles / 2 + 100) rig.world->power(7_node, true);
    trapped_cycle(master, port);
    for (ImageView image; master.take(image);) ++images;
    for (Reply reply; master.take(reply);) ++replies;
    for (Event event; master.take(event);) {
    }
  }
  const bool good = images == cycles && replies + 2 >= requests && rig.all_ready();
  std::printf("%llu cycles of %u nodes, %llu requests answered, nothing allocated\n",
              static_cast<unsigned long long>(images), nodes,
              static_cast<unsigned long long>(replies));
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return prove(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000);
}
