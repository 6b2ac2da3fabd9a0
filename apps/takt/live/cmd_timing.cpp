#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/live/image_delay.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/view/timing_table.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time silence_limit = std::chrono::milliseconds{3500};

struct TimingOptions {
  LiveOptions live;
  bool follow = false;
};

void print(const std::string& bus, const timing_t& timing, const TimingOptions& options) {
  if (options.live.json) {
    nlohmann::json document = timing_json(timing);
    document["bus"] = bus;
    const int indent = options.follow ? one_line : 1;
    std::puts(json_text(document, indent).c_str());
  } else {
    std::printf("%s at cycle %lld, the last second\n", bus.c_str(),
                static_cast<long long>(timing.cycle));
    const std::size_t width = output_width();
    print_lines(timing_lines(timing, width), width);
  }
  std::fflush(stdout);
}

/// Receives the timing messages and the images of one bus.
class TimingListener {
 public:
  TimingListener(LcmClient lcm, const std::string& bus)
      : lcm_{std::move(lcm)},
        timing_channel_{channel_name(bus, "TIMING")},
        image_channel_{channel_name(bus, "IMAGE")} {}

  /// Returns the next timing_t, with the delays of the images that have arrived since the previous
  /// timing_t. Returns std::nullopt if none comes in time, or after Ctrl-C.
  std::optional<timing_t> next() {
    newest_.reset();
    const Time until = monotonic_now() + silence_limit;
    while (!newest_ && !Interrupt::asked() && monotonic_now() < until) {
      lcm_.serve([this](std::string_view from, Bytes data) { take(from, data); },
                 monotonic_now() + std::chrono::milliseconds{100});
    }
    return newest_;
  }

 private:
  void take(std::string_view from, Bytes data) {
    const Time now = monotonic_now();
    if (from == image_channel_) {
      if (const auto image = decode<image_t>(data)) delay_.take(*image, now, realtime_offset());
    } else if (from == timing_channel_) {
      auto timing = decode<timing_t>(data);
      if (!timing) return;
      timing->histograms.push_back(delay_.finish());
      ++timing->num_histograms;
      newest_ = std::move(*timing);
    }
  }

  LcmClient lcm_;
  std::string timing_channel_;
  std::string image_channel_;
  ImageDelay delay_;
  std::optional<timing_t> newest_;
};

int run(const TimingOptions& options) {
  const Interrupt interrupt;
  const std::string bus = DaemonClient::find(options.live).status().bus;
  TimingListener listener{open_live(options.live, {"TIMING", "IMAGE"}), bus};
  listener.next();  // discards the first message, so that all later rows cover the same second
  do {
    const auto timing = listener.next();
    if (Interrupt::asked()) break;
    if (!timing) throw Failure{"the daemon of bus '" + bus + "' sends no timing messages any more"};
    print(bus, *timing, options);
  } while (options.follow);
  return 0;
}

}  // namespace

void add_timing(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<TimingOptions>(
      app, exit_code, "timing", "shows how punctual the cycle of a running daemon is", run);
  verb.footer(
      "The table covers the last second. It shows how late SYNC was sent, and the times after\n"
      "SYNC at which the last synchronous PDO came, the image was complete, LCM got the image,\n"
      "and this program received it (on the machine of the daemon). The last row is the age of\n"
      "the set-points when they were sent.\n"
      "Each column of the picture covers twice the time of the column before.\n"
      "Examples:\n"
      "  takt timing\n"
      "  takt timing --follow --json > night.jsonl");
  verb.add_flag("-f,--follow", options.follow, "print each second, until interrupted");
  add_live_options(verb, options.live);
}

}  // namespace takt
