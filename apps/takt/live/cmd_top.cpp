#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <unistd.h>

#include "apps/command_line/commands.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/top_frame.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time frame_period = std::chrono::milliseconds{100};
constexpr Time first_limit = std::chrono::seconds{3};

struct TopArguments {
  LiveOptions live;
  bool once = false;
};

std::atomic<bool> interrupted{false};

/// Returns the bus to show, the first if there are several. Returns null if there is none.
const BusView* shown(const BusViews& views, const std::string& bus_name) {
  const auto buses = chosen(views, bus_name);
  return buses.empty() ? nullptr : buses.front();
}

void show_once(LcmClient& lcm, BusViews& views, const std::string& bus_name) {
  const Time limit = monotonic_now() + first_limit;
  listen(lcm, views, limit, [&] {
    const BusView* const bus = shown(views, bus_name);
    return bus != nullptr && !bus->values().empty() && bus->timing();
  });
  const BusView* const bus = shown(views, bus_name);
  if (bus == nullptr) throw no_bus(views, lcm, bus_name);
  print_lines(top_frame(*bus, {.rows = 0}).lines);
  std::fflush(stdout);
  refuse_two_daemons({bus});
}

/// Returns false if the key ends the program.
bool on_key(int key, TopOptions& options) {
  if (key == 'q' || key == 'Q') return false;
  if (key == Screen::key_down || key == 'j') ++options.first_signal;
  if ((key == Screen::key_up || key == 'k') && options.first_signal > 0) --options.first_signal;
  return true;
}

void show_live(LcmClient& lcm, BusViews& views, const std::string& bus_name) {
  for (const int number : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
    std::signal(number, [](int) { interrupted = true; });
  }
  const Screen screen;
  TopOptions options;
  Time next_frame = monotonic_now();
  while (!interrupted) {
    while (const int key = Screen::key()) {
      if (!on_key(key, options)) return;
    }
    next_frame = monotonic_now() + frame_period;
    listen(lcm, views, next_frame, [] { return interrupted.load(); });
    options.rows = Screen::size().rows;
    const BusView* const bus = shown(views, bus_name);
    if (bus != nullptr) {
      const TopFrame frame = top_frame(*bus, options);
      options.first_signal = frame.first_signal;
      screen.show(frame.lines);
    } else {
      const std::string why = views.buses().empty() ? "no daemon answers on " + lcm.where()
                                                    : no_bus(views, lcm, bus_name).what();
      screen.show({Line{}.add(why + " (q quits)", Paint::dim)});
    }
  }
}

int run(const TopArguments& arguments) {
  LcmClient lcm =
      open_live(arguments.live, {"STATUS", "LAYOUT", "IMAGE", "TIMING", "EVENT", "SYNC"});
  BusViews views;
  const bool live = !arguments.once && ::isatty(STDOUT_FILENO) != 0 && ::isatty(STDIN_FILENO) != 0;
  (live ? show_live : show_once)(lcm, views, arguments.live.bus_name);
  return 0;
}

}  // namespace

void add_top(CLI::App& app, int& exit_code) {
  auto [verb, arguments] = add_command<TopArguments>(app, exit_code, "top",
                                                     "shows a live view of a running daemon", run);
  verb.footer(
      "Keys: q quits, arrows scroll the values.\nExamples:\n  takt top\n"
      "  takt top --once            prints the view once, for scripts\n"
      "  takt top --bus-name lift");
  add_bus_choice(verb, arguments.live);
  verb.add_flag("--once", arguments.once, "print the view once and end");
}

}  // namespace takt
