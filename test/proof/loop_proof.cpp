// Runs the real bus loop on a real thread, recorded for the black box: 500 cycles with four nodes,
// one of which stops answering half-way. The thread may not allocate or free memory, and the only
// system calls that it may make are sleep, receive, send and poll.
//
//   loop_proof                 over a socket pair; exits 0
//   loop_proof --can IFACE     on SocketCAN; the interface goes down and up in between, and the
//                              calls that find it again are allowed, too
//   ... --break WHAT           new, delete, malloc, yield, open, write: breaks the rule inside the
//                              cycle; has to exit 97 (allocation) or 98 (system call)
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <functional>
#include <linux/can/raw.h>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "master/linux/can/socket_can.hpp"
#include "master/linux/unix_bus/unix_bus.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/recorded_port.hpp"
#include "test/proof/allocation_trap.hpp"
#include "test/proof/syscall_trap.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr unsigned nodes = 4;
constexpr std::uint64_t cycles = 500;

/// Breaks the rule once, in a cycle.
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
    if (what_ == "open") ::close(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    if (what_ == "write") [[maybe_unused]]
      const ssize_t written = ::write(STDOUT_FILENO, "\n", 1);
  }

 private:
  std::string_view what_;
  bool broken_ = false;
  int* kept_ = nullptr;
  int* before_ = new int{3};
};

/// An event on the bus before the cycles that count. It runs on the thread of the devices.
using Mishap = std::function<void()>;

constexpr std::uint64_t beats_before_mishap = 50;
constexpr std::uint64_t most_cycles = 20 * cycles;  // limit for a run that does not end

/// State that both threads use.
struct Course {
  std::atomic<bool> mishap_over{false};
  std::atomic<bool> done{false};
};

/// Sends the boot-up messages and heartbeats of all nodes, and a TPDO of each node after every
/// SYNC.
template <class P>
void run_devices(P& port, const Mishap& mishap, Course& course) {
  std::vector<StampedFrame> in(256);
  std::uint64_t beats = 0;
  while (!course.done) {
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
      if (beats != beats_before_mishap) continue;
      mishap();
      course.mishap_over = true;
    }
  }
}

/// Runs the loop in the bus thread. Both traps are on from here.
template <class P>
void run_trapped(BusLoop<P, RecordedLink>& loop, std::span<const proof::SystemCall> allowed,
                 Course& course) {
  proof::trap_system_calls(allowed);
  proof::trap_allocations(true);
  loop.start();
  std::uint64_t left = cycles;
  for (std::uint64_t all = 0; left > 0 && all < most_cycles; ++all) {
    loop.cycle();
    left -= course.mishap_over;
  }
  proof::trap_allocations(false);
  course.done = true;
  for (;;) takt::sleep_until(monotonic_now() + 1s);  // ending a thread takes system calls
}

BusPlan small_plan() {
  BusPlan plan = test::axes({.nodes = nodes, .period = 4ms});
  for (NodePlan& node : plan.nodes) node.boot_plan.steps.clear();
  return plan;
}

bool is_checkpoint(std::uint64_t word) {
  return journal::mark_of(word) == Mark::checkpoint && journal::payload_of(word) < 4096;
}

bool recorded(const Journal& journal) {
  return journal.wanted() != nullptr && !journal.wanted()->read().empty() &&
         std::ranges::any_of(journal.last().read(), is_checkpoint);
}

/// A loaded machine skips periods and outputs, but the bus must have worked nevertheless.
bool lively(const Exchange& exchange) {
  StatusSnapshot status;
  exchange.status.read(status);
  std::printf("%llu cycles, %llu frames received, %llu sent, %llu images with a missing PDO\n",
              static_cast<unsigned long long>(status.bus.beats),
              static_cast<unsigned long long>(status.bus.frames_received),
              static_cast<unsigned long long>(status.bus.frames_sent),
              static_cast<unsigned long long>(status.bus.images_incomplete));
  return status.bus.frames_received > cycles && status.bus.frames_sent > cycles / 2;
}

/// Returns how often the interface went down and came up, according to the events of the loop.
std::pair<int, int> interface_events(Exchange& exchange) {
  std::pair<int, int> reported{};
  for (Event event; exchange.events.pop(event);) {
    reported.first += event.kind == EventKind::interface_down;
    reported.second += event.kind == EventKind::interface_up;
  }
  std::printf("interface down %d times, up %d times\n", reported.first, reported.second);
  return reported;
}

struct Circumstances {
  std::string_view to_break;
  Mishap mishap = [] {};
  std::span<const proof::SystemCall> allowed{};
  std::pair<int, int> interface_events{};
};

template <class P>
int prove(const BusPlan& plan, P& master_port, P& device_port, const Circumstances& given) {
  const auto exchange = std::make_unique<Exchange>(plan);
  Breaker breaker{given.to_break};
  Journal journal{1 << 20};  // holds checkpoints, begins anew now and then
  journal.want();
  RecordedPort<P> port{master_port, &journal};
  const auto loop = std::make_unique<BusLoop<RecordedPort<P>, RecordedLink>>(
      plan, port, RecordedLink{*exchange, &journal}, BusLoopOptions{.controller = &breaker});

  Course course;
  std::thread devices{[&] { run_devices(device_port, given.mishap, course); }};
  std::thread bus{[&] { run_trapped(*loop, given.allowed, course); }};
  devices.join();

  const bool as_reported = interface_events(*exchange) == given.interface_events;
  const bool good = lively(*exchange) && recorded(journal) && as_reported;
  std::fflush(stdout);
  std::_Exit(good ? 0 : 1);  // the bus thread still sleeps
}

int prove_on_socket_pair(std::string_view to_break) {
  auto [master_port, device_port] = make_socket_pair_bus();
  return prove(small_plan(), master_port, device_port, {.to_break = to_break});
}

/// The calls that look for an interface that is gone: its flags, its index, filters, binding, the
/// old error.
constexpr std::array<proof::SystemCall, 5> search{{
    {SYS_ioctl, 1, SIOCGIFFLAGS},
    {SYS_ioctl, 1, SIOCGIFINDEX},
    {SYS_setsockopt, 1, SOL_CAN_RAW},
    {SYS_bind},
    {SYS_getsockopt, 2, SO_ERROR},
}};

int prove_on_can(const std::string& interface, std::string_view to_break) {
  const BusPlan plan = small_plan();
  auto master_port = SocketCanPort::open(interface, plan, 0ns);
  auto device_port = SocketCanPort::open(
      {.interface = interface, .filters = {{.can_id = 0x080, .can_mask = CAN_SFF_MASK}}});
  if (!master_port || !device_port) {
    std::fprintf(stderr, "loop_proof: %s\n",
                 (master_port ? device_port : master_port).error().message.c_str());
    return 1;
  }
  const std::string link = "ip link set " + interface;
  const Mishap mishap = [command = link + " down && sleep 0.2 && " + link + " up"] {
    if (std::system(command.c_str()) != 0) std::_Exit(1);
  };
  return prove(
      plan, *master_port, *device_port,
      {.to_break = to_break, .mishap = mishap, .allowed = search, .interface_events = {1, 1}});
}

}  // namespace

int main(int argc, char** argv) {
  std::string_view to_break;
  std::string interface;
  int i = 1;
  for (; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--break") to_break = argv[i + 1];
    if (option == "--can") interface = argv[i + 1];
  }
  if (i == argc) {
    return interface.empty() ? prove_on_socket_pair(to_break) : prove_on_can(interface, to_break);
  }
  std::fprintf(stderr,
               "usage: loop_proof [--can IFACE] [--break new|delete|malloc|yield|open|write]\n");
  return 2;
}
