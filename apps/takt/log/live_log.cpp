#include "apps/takt/log/live_log.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/log/image_rows.hpp"
#include "apps/takt/log/log_output.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/clock.hpp"

namespace takt::logging {
namespace {

using namespace std::chrono_literals;

/// A daemon sends the layout once a second.
constexpr Time layout_limit = 5s;
/// A daemon sends its status ten times a second. If none has come for this time, the daemon has
/// ended.
constexpr Time silence_limit = 3s;

class LiveLog {
 public:
  explicit LiveLog(const LiveLogOptions& options)
      : options_{options},
        status_{DaemonClient::find(options.live).status()},
        lcm_{open_live(options.live, {"LAYOUT", "IMAGE", "EVENT", "STATUS"})} {}

  void run() {
    const Interrupt interrupt;
    const Time layout_until = monotonic_now() + layout_limit;
    heard_ = monotonic_now();
    while (reason_.empty()) {
      lcm_.serve([this](std::string_view from, Bytes data) { take(from, data); },
                 monotonic_now() + 100ms);
      if (!output_) begin();
      if (!output_ && monotonic_now() > layout_until) {
        throw Failure{"the daemon of bus '" + status_.bus + "' sends no layout"};
      }
      if (reason_.empty()) reason_ = end_reason();
    }
    if (!output_) throw Failure{"nothing was recorded: " + reason_, 1};
    report_daemon();
    output_->finish(reason_);
  }

 private:
  const BusView* view() const {
    const auto buses = chosen(views_, status_.bus);
    return buses.empty() ? nullptr : buses.front();
  }

  /// Begins the log when the layout has come. The patterns are checked before a file is made.
  void begin() {
    const BusView* const bus = view();
    if (bus == nullptr || bus->signals().empty() || bus->session() != status_.session) return;
    LogHead head{.bus = status_.bus,
                 .period = Time{status_.period_ns},
                 .signals = value_or_fail(choose_signals(bus->signals(), options_.patterns),
                                          exit_wrong_use)};
    output_.emplace(options_.output, head, false);
    rows_.emplace(head.signals);
    std::fprintf(stderr, "takt: recording %zu signal%s of bus '%s'%s\n", head.signals.size(),
                 head.signals.size() == 1 ? "" : "s", printable_text(status_.bus).c_str(),
                 options_.length ? "" : "; Ctrl-C ends the recording");
  }

  void take(std::string_view channel, Bytes data) {
    if (channel == channel_name(status_.bus, "IMAGE")) return take_image(data);
    if (channel == channel_name(status_.bus, "EVENT")) return take_event(data);
    views_.take(channel, data);
    if (channel == channel_name(status_.bus, "STATUS")) heard_ = monotonic_now();
  }

  void take_image(Bytes data) {
    if (!rows_ || !reason_.empty()) return;
    const auto image = decode<image_t>(data);
    if (!image || image->session != status_.session) return;
    const auto row = rows_->take(*image);
    if (!row) return;
    heard_ = monotonic_now();
    if (!begin_ns_) begin_ns_ = row->sync_ns;
    if (options_.length && row->sync_ns - *begin_ns_ > options_.length->count()) {
      reason_ = "ended by --for";
    } else if (!output_->row(*row)) {
      reason_ = "the file is full";
    }
  }

  void take_event(Bytes data) {
    if (!output_ || !reason_.empty()) return;
    auto event = decode<event_t>(data);
    if (!event || event->session != status_.session) return;
    const bool written = output_->event({.utime = event->utime,
                                         .cycle = event->cycle,
                                         .severity = event->severity,
                                         .node = std::move(event->node),
                                         .kind = std::move(event->kind),
                                         .text = std::move(event->text)});
    if (!written) reason_ = "the file is full";
  }

  /// Returns the reason why the log ends now, or an empty text if the log continues.
  std::string end_reason() {
    if (Interrupt::asked()) return "ended by a signal";
    const BusView* const bus = view();
    if (bus != nullptr && bus->session() != status_.session) {
      return "ended because taktd was started again";
    }
    if (monotonic_now() - heard_ > silence_limit) return "ended because taktd has ended";
    return {};
  }

  /// Prints how many cycles the daemon itself has missed during the log.
  void report_daemon() const {
    const BusView* const bus = view();
    if (bus == nullptr || !bus->status()) return;
    const std::int64_t missed = bus->status()->cycles_missed - status_.cycles_missed;
    const std::int64_t dropped = bus->status()->image_overruns - status_.image_overruns;
    if (missed <= 0 && dropped <= 0) return;
    std::fprintf(
        stderr,
        "takt: during this recording, taktd missed %lld cycles and did not publish %lld images\n",
        static_cast<long long>(missed), static_cast<long long>(dropped));
  }

  const LiveLogOptions& options_;
  status_t status_;
  LcmClient lcm_;
  BusViews views_;
  std::optional<LogOutput> output_;
  std::optional<ImageRows> rows_;
  std::optional<std::int64_t> begin_ns_;
  Time heard_{};
  std::string reason_;
};

}  // namespace

void log_live(const LiveLogOptions& options) {
  format_of(options.output);  // reports a wrong file name before the wait for a daemon
  LiveLog{options}.run();
}

}  // namespace takt::logging
