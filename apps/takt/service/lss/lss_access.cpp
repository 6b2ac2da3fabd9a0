#include "apps/takt/service/lss/lss_access.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/takt/service/lss/lss_reply.hpp"
#include "master/core/lss/lss_runner.hpp"
#include "master/linux/clock.hpp"
#include "master/wire/lss.hpp"

namespace takt {
namespace {

/// Returns the longest time that these services may take.
Time longest(std::span<const LssCommand> commands, Time timeout) {
  constexpr int questions = 300;  // questions of a scan, with repetitions
  Time sum = std::chrono::seconds{2};
  for (const LssCommand& command : commands) {
    const Time wait = timeout > Time{} ? timeout : default_timeout(command.op);
    const bool scans = command.op == LssOp::fast_scan || command.op == LssOp::slow_scan;
    sum += scans ? questions * (wait + std::chrono::milliseconds{20}) : wait;
  }
  return sum;
}

}  // namespace

LssAccess::LssAccess(const LssAccessOptions& options) : options_{options} {
  if (options.bus.empty()) {
    daemon_.emplace(DaemonClient::find(options.live));
  } else {
    channel_.emplace(value_or_fail(FrameChannel::open(options.bus, BusMember::guest), 3));
  }
}

std::vector<LssResult> LssAccess::run(std::span<const LssCommand> commands) {
  return daemon_ ? ask(commands) : talk(commands);
}

std::vector<LssResult> LssAccess::ask(std::span<const LssCommand> commands) {
  request_t request = make_request("lss");
  request.timeout_ms = options_.timeout_ms;
  std::vector<std::byte> packed(commands.size() * lss_command_bytes);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    pack(commands[i], std::span{packed}.subspan(i * lss_command_bytes).first<lss_command_bytes>());
  }
  set_data(request, packed);
  const reply_t reply = daemon_->ask(
      std::move(request), longest(commands, std::chrono::milliseconds{options_.timeout_ms}));
  if (reply.good == 0 && reply.data.empty()) throw Failure{reply.text, 1};
  auto results = lss_results(std::as_bytes(std::span{reply.data}), commands);
  if (results) return std::move(*results);
  if (reply.good == 0) throw Failure{reply.text, 1};
  throw Failure{"the daemon of bus '" + daemon_->status().bus + "' " + results.error()};
}

std::vector<LssResult> LssAccess::talk(std::span<const LssCommand> commands) {
  LssRunner runner;
  runner.begin(commands, std::chrono::milliseconds{options_.timeout_ms});
  Outbox out;
  while (runner.running()) {
    runner.on_time(monotonic_now(), out);
    if (channel_->send(out.frames()).sent != out.frames().size()) {
      throw Failure{"a frame could not be sent on " + options_.bus};
    }
    out.clear();
    StampedFrame frame;
    const Time pause = std::clamp<Time>(runner.deadline() - monotonic_now(), Time{},
                                        std::chrono::milliseconds{100});
    if (!channel_->receive(frame, pause)) continue;
    if (frame.frame.id == lss::answer_cob_id) runner.on_frame(frame.frame, monotonic_now(), out);
  }
  return {runner.results().begin(), runner.results().end()};
}

}  // namespace takt
