#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/takt/commands.hpp"
#include "apps/takt/daemon_client.hpp"
#include "apps/takt/timing_table.hpp"
#include "master/gateway/names.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time silence_limit = std::chrono::milliseconds{3500};

struct TimingOptions {
  LiveOptions live;
  bool follow = false;
};

std::atomic<bool> interrupted = false;

void print(const std::string& bus, const timing_t& timing, const TimingOptions& options) {
  if (options.live.json) {
    nlohmann::json document = timing_json(timing);
    document["bus"] = bus;
    const int indent = options.follow ? -1 : 1;
    std::puts(document.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    std::printf("%s at cycle %lld, the last second\n", bus.c_str(),
                static_cast<long long>(timing.cycle));
    for (const std::string& line : timing_lines(timing)) std::puts(line.c_str());
  }
  std::fflush(stdout);
}

/// The next message of that bus.
std::optional<timing_t> next(LcmClient& lcm, const std::string& channel) {
  std::optional<timing_t> newest;
  const Time until = monotonic_now() + silence_limit;
  while (!newest && !interrupted && monotonic_now() < until) {
    lcm.serve(
        [&](std::string_view from, Bytes data) {
          if (from != channel) return;
          if (auto timing = decode<timing_t>(data)) newest = std::move(*timing);
        },
        monotonic_now() + std::chrono::milliseconds{100});
  }
  return newest;
}

int run(const TimingOptions& options) {
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  const auto daemon = DaemonClient::find(options.live);
  if (!daemon) return complain(daemon.error().sentence, daemon.error().code);
  const std::string& bus = daemon->status().bus;
  auto lcm = LcmClient::open(options.live.lcm_url, {any_bus("TIMING")});
  if (!lcm) return complain(lcm.error(), 3);
  do {
    const auto timing = next(*lcm, channel_name(bus, "TIMING"));
    if (interrupted) break;
    if (!timing) return complain("the daemon of bus '" + bus + "' has gone silent", 3);
    print(bus, *timing, options);
  } while (options.follow);
  return 0;
}

}  // namespace

void add_timing(CLI::App& app, int& exit_code) {
  auto* verb = app.add_subcommand("timing", "how punctual the cycle of a running daemon is");
  verb->footer(
      "Times of the last second: how late SYNC went out, when the last synchronous PDO and the\n"
      "image came after it, how old set-points were when they were sent. Each column of the\n"
      "picture is twice as long a time as the one before.\n"
      "Examples:\n  takt timing\n  takt timing --follow --json > night.jsonl");
  auto options = std::make_shared<TimingOptions>();
  verb->add_flag("-f,--follow", options->follow, "each second, until interrupted");
  add_live_options(*verb, options->live);
  verb->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace takt
