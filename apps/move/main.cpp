#include <csignal>
#include <fmt/format.h>
#include <sched.h>
#include <string>
#include <takt/axis.hpp>
#include <takt/lcm.hpp>
#include <unistd.h>
#include <utility>
#include <vector>

#include "apps/axis/lcm_access.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/move/held_axes.hpp"
#include "apps/move/move_options.hpp"
#include "apps/move/move_run.hpp"
#include "apps/plot/motion/motion_plot.hpp"

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

int run(const takt::MoveOptions& options) {
  auto lcm = takt::open_lcm(takt::LcmAccess{
      .url = options.lcm_url, .keys = options.keys, .check_images = options.check_images});
  if (!lcm) {
    const bool wrong = lcm.error().kind == takt::Obstacle::Kind::wrong_use;
    throw takt::Failure{lcm.error().text, wrong ? 2 : 3};
  }
  takt::MotionPlot plot{options.plot, "takt-move"};
  if (const auto created = plot.create(); !created) throw takt::Failure{created.error(), 2};
  takt::AxisGroup group{plot.listen(std::move(*lcm)),
                        {.bus = options.bus,
                         .sender = fmt::format("takt-move {}", ::getpid()),
                         .stale_cycles = options.stale_cycles}};
  if (!options.keys.empty()) {
    group.sign_with(takt::value_or_fail(takt::load_keys(options.keys), 2).front());
  }
  const int code = takt::MoveRun{group, options, stop}.run();
  std::vector<std::string> names;
  for (const auto axis : takt::numbers_of(group.axes())) names.push_back(group.axes().name(axis));
  const auto written = plot.write(group, names);
  if (!written && code == 0) throw takt::Failure{written.error(), 1};
  return code;
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
