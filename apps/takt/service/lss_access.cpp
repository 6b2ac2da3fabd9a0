#include "apps/takt/service/lss_access.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/takt/service/lss_reply.hpp"
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

std::expected<LssAccess, LiveError> LssAccess::open(const LssAccessOptions& options) {
  LssAccess access;
  access.options_ = options;
  if (options.bus.empty()) {
    auto daemon = DaemonClient::find(options.live);
    if (!daemon) return std::unexpected{daemon.error()};
    access.daemon_.emplace(std::move(*daemon));
    return access;
  }
  auto channel = FrameChannel::open(options.bus, BusMember::guest);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  access.channel_.emplace(std::move(*channel));
  return access;
}

std::expected<std::vector<LssResult>, LiveError> LssAccess::run(
    std::span<const LssCommand> commands) {
  return daemon_ ? ask(commands) : talk(commands);
}

std::expected<std::vector<LssResult>, LiveError> LssAccess::ask(
    std::span<const LssCommand> commands) {
  request_t request{};
  request.service = "lss";
  request.timeout_ms = options_.timeout_ms;
  for (const LssCommand& command : commands) {
    std::array<std::byte, lss_command_bytes> bytes{};
    pack(command, bytes);
    for (const std::byte byte : bytes) request.data.push_back(std::to_integer<std::uint8_t>(byte));
  }
  request.size = static_cast<std::int32_t>(request.data.size());
  const auto reply = daemon_->ask(
      std::move(request), longest(commands, std::chrono::milliseconds{options_.timeout_ms}));
  if (!reply) return std::unexpected{reply.error()};
  if (reply->good == 0 && reply->data.empty()) return std::unexpected{LiveError{reply->text, 1}};
  auto results = lss_results(std::as_bytes(std::span{reply->data}), commands);
  if (results) return std::move(*results);
  if (reply->good == 0) return std::unexpected{LiveError{reply->text, 1}};
  return std::unexpected{
      LiveError{"the daemon of bus '" + daemon_->status().bus + "' " + results.error(), 3}};
}

std::expected<std::vector<LssResult>, LiveError> LssAccess::talk(
    std::span<const LssCommand> commands) {
  LssRunner runner;
  runner.begin(commands, std::chrono::milliseconds{options_.timeout_ms});
  Outbox out;
  while (runner.running()) {
    runner.on_time(monotonic_now(), out);
    if (channel_->send(out.frames()).sent != out.frames().size()) {
      return std::unexpected{LiveError{"a frame could not be sent on " + options_.bus, 3}};
    }
    out.clear();
    StampedFrame frame;
    const Time pause = std::clamp<Time>(runner.deadline() - monotonic_now(), Time{},
                                        std::chrono::milliseconds{100});
    if (!channel_->receive(frame, pause)) continue;
    if (frame.frame.id == lss::answer_cob_id) runner.on_frame(frame.frame, monotonic_now(), out);
  }
  return std::vector<LssResult>(runner.results().begin(), runner.results().end());
}

}  // namespace takt
