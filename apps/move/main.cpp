#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <sched.h>
#include <takt/axis.hpp>
#include <takt/lcm.hpp>
#include <unistd.h>
#include <utility>

#include "apps/command_line/failure.hpp"
#include "apps/move/move_options.hpp"
#include "apps/move/move_run.hpp"
#include "master/lcm/envelope/checked_transport.hpp"
#include "master/lcm/envelope/key_file.hpp"

namespace {

volatile std::sig_atomic_t stop = 0;

void on_signal(int) { stop = stop == 0 ? 1 : 2; }

/// The terminal was closed. SIGHUP and SIGPIPE may come several times; they never count as the
/// second signal.
void on_hangup(int) {
  if (stop == 0) stop = 1;
}

/// Asks for a priority above ordinary programs and below taktd. Without the rights for it, the
/// program keeps its ordinary priority.
void ask_for_real_time() {
  const sched_param parameters{.sched_priority = 20};
  ::sched_setscheduler(0, SCHED_FIFO, &parameters);
}

/// Opens LCM. If the options require it, the connection accepts only messages that the daemon has
/// signed.
std::unique_ptr<takt::Transport> open_lcm(const takt::MoveOptions& options) {
  auto lcm = takt::value_or_fail(takt::open_lcm(options.lcm_url), 3);
  if (!options.check_images) return lcm;
  if (options.keys.empty()) {
    throw takt::Failure{"--check-images needs a key file: --keys FILE", 2};
  }
  auto keys = takt::value_or_fail(takt::WatchedKeyFile::open(options.keys), 2);
  return std::make_unique<takt::CheckedTransport>(std::move(lcm), std::move(keys));
}

int run(const takt::MoveOptions& options) {
  takt::AxisGroup group{open_lcm(options),
                        {.bus = options.bus,
                         .sender = fmt::format("takt-move {}", ::getpid()),
                         .stale_cycles = options.stale_cycles}};
  if (!options.keys.empty()) {
    group.sign_with(takt::value_or_fail(takt::load_keys(options.keys), 2).front());
  }
  return takt::MoveRun{group, options, stop}.run();
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, exit_code] = takt::parse_move(argc, argv);
  if (exit_code) return *exit_code;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_hangup) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // under nohup
  std::signal(SIGPIPE, on_hangup);
  ask_for_real_time();
  try {
    return run(options);
  } catch (const takt::Failure& failure) {
    fmt::print(stderr, "takt-move: {}\n", failure.what());
    return failure.code;
  }
}
