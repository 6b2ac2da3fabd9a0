// The real bus loop on a real thread over a socket pair: 500 cycles with four nodes that answer,
// one of which falls silent half-way, recorded for the black box. Its thread may not allocate, free
// or make any system call but sleep, receive, send and poll.
//
//   loop_proof                 exits 0
//   loop_proof --break WHAT    new, delete, malloc, yield, open: breaks the rule inside the cycle;
//                              has to exit 97 (allocation) or 98 (system call)
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>

#include "master/linux/unix_bus.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/rt/recorded_port.hpp"
#include "test/proof/allocation_trap.hpp"
#include "test/proof/syscall_trap.hpp"
#include "test/unit/rt/small_plan.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr unsigned nodes = 4;
constexpr std::uint64_t cycles = 500;

/// What a programmer should not do in a cycle.
class Breaker final : public Controller {
 public:
  explicit Breaker(std::string_view what) : what_{what} {}
  void update(const ImageView& image, OutputWriter& outputs) noexcept override {
    for (SignalIndex i = 2 * nodes; i < 4 * nodes; ++i) outputs.set(i, 7);
    if (image.beat < 100 || std::exchange(broken_, true)) return;
    if (what_ == "new") kept_ = new int{5};
    if (what_ == "delete") delete before_;
    if (what_ == "malloc") kept_ = static_cast<int*>(std::malloc(16));
    if (what_ == "yield") std::this_thread::yield();
    if (what_ == "open") std::fclose(std::fopen("/dev/null", "r"));
  }

 private:
  std::string_view what_;
  bool broken_ = false;
  int* kept_ = nullptr;
  int* before_ = new int{3};
};

/// Boot-up and heartbeats of all nodes, and a TPDO of each after every SYNC.
void run_devices(UnixBusPort& port, const std::atomic<bool>& done) {
  std::vector<StampedFrame> in(256);
  std::uint64_t beats = 0;
  while (!done) {
    port.wait_frame(port.now() + 5ms);
    const std::size_t count = port.receive(in);
    for (std::size_t i = 0; i < count; ++i) {
      if (in[i].frame.id != CobId::base(0x080)) continue;
      ++beats;
      std::vector<Frame> out;
      for (std::uint32_t node = 1; node <= nodes; ++node) {
        if (beats % 10 == 0) out.push_back(make_frame(CobId::base(0x700 + node), {5}));
        if (node == nodes && beats > cycles / 2) continue;
        out.push_back(make_frame(CobId::base(0x180 + node), {0x37, 0x02, 1, 2, 3, 4}));
      }
      port.send(out);
    }
  }
}

bool is_checkpoint(std::uint64_t word) {
  return journal::mark_of(word) == Mark::checkpoint && journal::payload_of(word) < 4096;
}

int prove(std::string_view to_break) {
  BusPlan plan = test::axes({.nodes = nodes, .period = 4ms});
  for (NodePlan& node : plan.nodes) node.boot_plan.steps.clear();
  auto [master_port, device_port] = make_socket_pair_bus();
  const auto exchange = std::make_unique<Exchange>(plan);
  Breaker breaker{to_break};
  Journal journal{256 << 10};  // begins anew now and then
  journal.want();
  RecordedPort<UnixBusPort> port{master_port, &journal};
  const auto loop = std::make_unique<BusLoop<RecordedPort<UnixBusPort>>>(
      plan, port, *exchange, BusLoopOptions{.controller = &breaker});

  std::atomic<bool> done{false};
  std::thread devices{[&, &port = device_port] { run_devices(port, done); }};
  std::thread bus{[&] {
    proof::trap_system_calls();
    proof::trap_allocations(true);
    loop->start();
    for (std::uint64_t i = 0; i < cycles; ++i) loop->cycle();
    proof::trap_allocations(false);
    done = true;
    for (;;) takt::sleep_until(monotonic_now() + 1s);  // ending a thread takes system calls
  }};
  devices.join();

  StatusSnapshot status;
  exchange->status.read(status);
  std::printf("%llu cycles, %llu frames received, %llu sent, %llu images with a missing PDO\n",
              static_cast<unsigned long long>(status.bus.beats),
              static_cast<unsigned long long>(status.bus.frames_received),
              static_cast<unsigned long long>(status.bus.frames_sent),
              static_cast<unsigned long long>(status.bus.images_incomplete));
  const bool recorded = journal.wanted() != nullptr && !journal.wanted()->read().empty() &&
                        std::ranges::any_of(journal.last().read(), is_checkpoint);
  // A loaded machine leaves out periods and outputs; the bus has to have lived all the same.
  const bool lively = status.bus.frames_received > cycles && status.bus.frames_sent > cycles / 2;
  std::fflush(stdout);
  std::_Exit(lively && recorded ? 0 : 1);  // the bus thread sleeps on
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view{argv[1]} == "--break") return prove(argv[2]);
  if (argc == 1) return prove("");
  std::fprintf(stderr, "usage: loop_proof [--break new|delete|malloc|yield|open]\n");
  return 2;
}
