#include "apps/takt/demo/demo_run.hpp"

#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <poll.h>
#include <utility>
#include <vector>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/interrupt.hpp"
#include "master/lcm/tcpq/tcpq_parser.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/tcp_loopback.hpp"

namespace takt {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds tick{100};
/// takt-move requires a limit of its time. This one is longer than any demo.
constexpr const char* very_long = "10080min";
/// Longest wait for taktd and the boot of its devices, in seconds.
constexpr const char* most_wait = "60";

/// Variables of the environment that would change the behaviour of the programs: keys of a real
/// machine, and the service manager that may have started this program.
const std::vector<std::string> not_passed_on{"TAKT_KEYS", "TAKT_CHECK_IMAGES", "NOTIFY_SOCKET",
                                             "WATCHDOG_USEC", "WATCHDOG_PID"};

/// Returns the usual port of LCM messages, or any other port if the usual one is in use.
std::uint16_t free_port() {
  auto listener = listen_on_loopback(tcpq::default_port);
  if (!listener) listener = listen_on_loopback(0);
  if (!listener) {
    throw Failure{std::string{"no port on 127.0.0.1 is free: "} + std::strerror(listener.error())};
  }
  return listener->port;
}

}  // namespace

DemoRun::DemoRun(DemoFiles files, const DemoOptions& options)
    : files_{std::move(files)},
      options_{options},
      url_{fmt::format("tcpq://127.0.0.1:{}", free_port())} {}

int DemoRun::run() {
  const Interrupt interrupt;
  output_.say(
      "The demo machine: two CiA 402 drives and an I/O module on a simulated bus. Nothing real "
      "moves.\n");
  start_daemon();
  if (!options_.still) start_motion();
  const Time end = options_.still && options_.run_for ? monotonic_now() + *options_.run_for : never;
  while (goes_on() && monotonic_now() < end) serve(tick);
  return this->end();
}

ChildProgram DemoRun::start(const std::filesystem::path& program, std::vector<std::string> words) {
  words.insert(words.end(), {"--lcm-url", url_});
  std::string command = program.filename().string();
  for (const std::string& word : words) command += ' ' + word;
  output_.say("$ " + command);
  words.insert(words.begin(), program.string());
  return value_or_fail(ChildProgram::start(words, not_passed_on), exit_wrong_use);
}

void DemoRun::start_daemon() {
  daemon_.emplace(start(files_.taktd, {files_.network.string(), "--bus", "sim"}));
}

void DemoRun::start_motion() {
  std::string duration = very_long;
  if (options_.run_for) {
    duration = fmt::format("{}ms", std::chrono::ceil<milliseconds>(*options_.run_for).count());
  }
  motion_.emplace(start(files_.takt_move, {"demo", "--for", duration, "--wait", most_wait}));
}

bool DemoRun::goes_on() const {
  return !Interrupt::asked() && daemon_->output() >= 0 && (!motion_ || motion_->output() >= 0);
}

/// Waits for output of the programs for at most `limit`, and prints it.
void DemoRun::serve(Time limit) {
  std::vector<pollfd> descriptors{{.fd = daemon_->output(), .events = POLLIN, .revents = 0}};
  if (motion_) {
    descriptors.push_back({.fd = motion_->output(), .events = POLLIN, .revents = 0});
  }
  const timespec longest = to_timespec(limit);
  if (::ppoll(descriptors.data(), descriptors.size(), &longest, nullptr) <= 0) return;
  if (descriptors[0].revents != 0) {
    daemon_->read([this](std::string_view line) { take_daemon_line(line); });
  }
  if (motion_ && descriptors[1].revents != 0) {
    motion_->read([this](std::string_view line) { take_motion_line(line); });
  }
}

void DemoRun::take_daemon_line(std::string_view line) {
  output_.line("taktd", line);
  if (options_.still && line.find("the network is ready") != line.npos) show_where_to_look();
}

void DemoRun::take_motion_line(std::string_view line) {
  if (line.find(" (error ") == line.npos) return output_.line("takt-move", line);
  if (!shown_) show_where_to_look();
  output_.positions("takt-move", line);
}

void DemoRun::show_where_to_look() {
  if (std::exchange(shown_, true)) return;
  std::string state = options_.still ? "The machine is ready." : "The axes move.";
  if (!options_.run_for) state += " Ctrl-C ends the demo.";
  output_.say(fmt::format(
      "\n{} Look at it from a second terminal:\n\n"
      "  export LCM_DEFAULT_URL={}\n"
      "  takt top                              the machine in one view\n"
      "  takt status                           its state in words\n"
      "  takt sdo read shoulder 6064 i32       an object of a drive\n"
      "{}"
      "  takt plan {}\n"
      "                                        all that taktd does with this machine\n",
      state, url_,
      options_.still ? "  takt-move demo --to 1.5               moves both axes\n"
                       "  takt-jog demo --velocity 1            moves one while a key is held\n"
                     : "",
      files_.network.string()));
}

/// Ends both programs in order: takt-move first, so that the axes come to rest, and then taktd,
/// which stops the bus.
int DemoRun::end() {
  if (Interrupt::asked())
    output_.say("\nThe demo ends: the axes come to rest, then taktd stops.\n");
  if (motion_) {
    if (daemon_->output() < 0 || Interrupt::asked()) motion_->ask_to_end();
    while (motion_->output() >= 0) serve(tick);
  }
  daemon_->ask_to_end();
  while (daemon_->output() >= 0) serve(tick);
  return sum_up(daemon_->wait(), motion_ ? motion_->wait() : 0);
}

int DemoRun::sum_up(int taktd, int takt_move) {
  // When it is interrupted, takt-move reports by its exit code whether its motion has reached its
  // end. This is no result of the demo.
  if (Interrupt::asked()) takt_move = 0;
  if (taktd == 0 && takt_move == 0) {
    output_.say(options_.still ? "\nGood: taktd stopped in order."
                               : "\nGood: the axes came to rest, and taktd stopped in order.");
    output_.say("Next: `takt --help`, and the page tutorial.md of the documentation.");
    return 0;
  }
  output_.say(fmt::format(
      "\nThe demo failed: takt-move ended with exit code {}, taktd with exit code {}.\nIf lines "
      "above report missed cycles, this computer was too busy: end other programs and try again.",
      takt_move, taktd));
  return taktd != 0 ? taktd : 1;
}

}  // namespace takt
