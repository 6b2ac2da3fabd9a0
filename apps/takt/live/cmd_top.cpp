#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <unistd.h>
#include <vector>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/view/top_frame.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time frame_period = std::chrono::milliseconds{100};
constexpr Time first_limit = std::chrono::seconds{3};

struct TopArguments {
  LiveOptions live;
  std::string page{page_names.front()};
  bool once = false;
};

std::atomic<bool> interrupted{false};

/// Returns the bus to show, the first if there are several. Returns null if there is none.
const BusView* shown(const BusViews& views, const std::string& bus_name) {
  const auto buses = chosen(views, bus_name);
  return buses.empty() ? nullptr : buses.front();
}

/// Returns true if everything has come that this page shows.
bool is_complete(const BusView& bus, Page page) {
  switch (page) {
    case Page::nodes:
      return true;
    case Page::timing:
      return bus.timing().has_value();
    case Page::pdos:
      return bus.pdos().has_value();
    default:
      return !bus.values().empty();
  }
}

void show_once(LcmClient& lcm, BusViews& views, const std::string& bus_name, Page page) {
  const Time limit = monotonic_now() + first_limit;
  listen(lcm, views, limit, [&] {
    const BusView* const bus = shown(views, bus_name);
    return bus != nullptr && is_complete(*bus, page);
  });
  const BusView* const bus = shown(views, bus_name);
  if (bus == nullptr) throw no_bus(views, lcm, bus_name);
  const std::size_t width = output_width();
  print_lines(top_frame(*bus, {.page = page, .columns = width, .rows = 0}).lines, width);
  std::fflush(stdout);
  refuse_two_daemons({bus});
}

void turn(TopOptions& options, std::size_t page) {
  options.page = static_cast<Page>(page % page_names.size());
  options.first_row = 0;
}

void scroll_up(TopOptions& options, std::size_t rows) {
  options.first_row -= std::min(options.first_row, rows);
}

/// Returns false if the key ends the program.
bool on_key(int key, TopOptions& options) {
  const auto page = static_cast<std::size_t>(options.page);
  const std::size_t many = std::max<std::size_t>(options.rows / 2, 1);
  if (key == 'q' || key == 'Q') return false;
  if (key >= '1' && key < '1' + static_cast<int>(page_names.size())) {
    turn(options, static_cast<std::size_t>(key - '1'));
  }
  if (key == '\t' || key == Screen::key_right) turn(options, page + 1);
  if (key == Screen::key_left) turn(options, page + page_names.size() - 1);
  if (key == Screen::key_down || key == 'j') ++options.first_row;
  if (key == Screen::key_page_down || key == ' ') options.first_row += many;
  if (key == Screen::key_up || key == 'k') scroll_up(options, 1);
  if (key == Screen::key_page_up || key == 'b') scroll_up(options, many);
  return true;
}

/// Acknowledges the events that have come.
void acknowledge(const BusView* bus, TopOptions& options) {
  if (bus == nullptr) return;
  for (const event_t& event : bus->events()) {
    options.seen_until = std::max(options.seen_until, event.utime);
  }
}

void show_live(LcmClient& lcm, BusViews& views, const std::string& bus_name, Page page) {
  for (const int number : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
    std::signal(number, [](int) { interrupted = true; });
  }
  const Screen screen;
  TopOptions options{.page = page};
  Time next_frame = monotonic_now();
  while (!interrupted) {
    while (const int key = Screen::key()) {
      if (!on_key(key, options)) return;
      if (key == 'a') acknowledge(shown(views, bus_name), options);
    }
    next_frame = monotonic_now() + frame_period;
    listen(lcm, views, next_frame, [] { return interrupted.load(); });
    const Screen::Size size = Screen::size();
    options.columns = size.columns;
    options.rows = size.rows;
    const BusView* const bus = shown(views, bus_name);
    if (bus != nullptr) {
      const TopFrame frame = top_frame(*bus, options);
      options.first_row = frame.first_row;
      screen.show(frame.lines);
    } else {
      const std::string why = views.buses().empty() ? "no daemon answers on " + lcm.where()
                                                    : no_bus(views, lcm, bus_name).what();
      screen.show(paragraph(why + " (q quits)", Paint::dim, size.columns, 2));
    }
  }
}

int run(const TopArguments& arguments) {
  const Page page = page_of(arguments.page).value_or(Page::axes);
  LcmClient lcm = open_live(arguments.live, {"STATUS", "LAYOUT", "IMAGE", "TIMING", "EVENT", "SYNC",
                                             "PDOS", "SPEED_AXES", "MOTION"});
  BusViews views;
  const bool live = !arguments.once && moves_cursor() && ::isatty(STDIN_FILENO) != 0;
  (live ? show_live : show_once)(lcm, views, arguments.live.bus_name, page);
  return 0;
}

}  // namespace

void add_top(CLI::App& app, int& exit_code) {
  auto [verb, arguments] = add_command<TopArguments>(app, exit_code, "top",
                                                     "shows a live view of a running daemon", run);
  verb.footer(
      "Pages: axes, words (statuswords and controlwords), io (all values), pdos, timing, nodes.\n\n"
      "Keys: 1 to 6, Tab and the left and right arrow keys choose a page; the up and down arrow\n"
      "keys, space and b scroll; a acknowledges the events that are shown; q quits. Without a\n"
      "terminal, or with TERM=dumb, takt top prints the view once.\n\n"
      "Following errors are those of the drive (0x60F4), else those of its motion, else the\n"
      "target minus the actual position. Values without units are counts (cnt).\n\n"
      "Examples:\n  takt top\n"
      "  takt top --page io\n"
      "  takt top --once            prints the view once, for scripts\n"
      "  takt top --bus-name lift");
  add_bus_choice(verb, arguments.live);
  verb.add_option("--page", arguments.page, "page to begin with")
      ->check(one_of(std::vector<std::string>(page_names.begin(), page_names.end())))
      ->capture_default_str();
  verb.add_flag("--once", arguments.once, "print the view once and end");
}

}  // namespace takt
