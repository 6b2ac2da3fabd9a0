#include "apps/takt/service/file_transfer.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "apps/command_line/interrupt.hpp"
#include "master/gateway/command/transfers.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time repeat_after = 300ms;  // if no state comes, a message was probably lost
constexpr Time ask_every = 1s;        // interval of status messages while the transfer runs
constexpr Time most_silence = 5s;     // longest time without a message from the daemon
constexpr std::size_t window = Transfers::parts_at_once * Transfers::part_bytes;

/// Calls a function at the end of its scope, also after a failure.
struct AtEnd {
  std::function<void()> call;
  ~AtEnd() { call(); }
};

}  // namespace

FileTransfer::FileTransfer(DaemonClient& daemon, Target target, Progress progress)
    : daemon_{daemon},
      target_{target},
      progress_{std::move(progress)},
      id_{realtime_now().count()},
      sender_{own_sender()} {}

transfer_t FileTransfer::message(const char* action) const {
  transfer_t out{};
  out.schema = message_schema;
  out.session = daemon_.status().session;
  out.id = id_;
  out.sender = sender_;
  out.action = action;
  out.node_id = target_.node;
  out.index = target_.object.index;
  out.sub = target_.object.sub;
  out.timeout_ms = target_.timeout_ms;
  return out;
}

void FileTransfer::send(transfer_t out) {
  out.utime = utime_now();
  daemon_.send("TRANSFER", encode(out, buffer_));
}

bool FileTransfer::hear(Time until) {
  const std::string channel = channel_name(daemon_.status().bus, "TRANSFER_STATE");
  bool heard = false;
  while (!heard && !daemon_.lacks_key() && monotonic_now() < until) {
    daemon_.serve(
        [&](std::string_view from, Bytes data) {
          if (from != channel) return;
          auto state = decode<transfer_state_t>(data);
          if (!state || state->id != id_ || state->sender != sender_) return;
          if (!state->data.empty() && state->offset == static_cast<std::int64_t>(value_.size())) {
            std::ranges::copy(std::as_bytes(std::span{state->data}), std::back_inserter(value_));
          }
          state_ = std::move(*state);
          heard = true;
        },
        std::min(until, monotonic_now() + 100ms));
    if (Interrupt::asked() && !std::exchange(aborted_, true)) send(message("abort"));
  }
  return heard;
}

/// Throws the reason if the transfer has failed.
void FileTransfer::check() const {
  if (state_.stage != "failed") return;
  throw Failure{aborted_ ? "interrupted; the transfer was aborted" : state_.text, 1};
}

void FileTransfer::begin(const char* action, std::size_t total) {
  transfer_t first = message(action);
  first.total = static_cast<std::int64_t>(total);
  for (const Time until = monotonic_now() + most_silence; monotonic_now() < until;) {
    send(first);
    if (hear(monotonic_now() + repeat_after)) return check();
    if (daemon_.lacks_key()) break;
  }
  throw daemon_.silence();
}

/// Sends the value in parts. The parts of one window follow each other without waiting; the daemon
/// reports how much it has received.
void FileTransfer::fill(std::span<const std::byte> value) {
  Time limit = monotonic_now() + most_silence;
  std::size_t sent = 0;
  while (state_.stage == "filling") {
    const auto received = static_cast<std::size_t>(state_.received);
    sent = std::max(sent, received);
    while (sent < std::min(received + window, value.size())) {
      transfer_t part = message("data");
      part.offset = static_cast<std::int64_t>(sent);
      const std::size_t size = std::min(Transfers::part_bytes, value.size() - sent);
      set_data(part, value.subspan(sent, size));
      send(std::move(part));
      sent += size;
    }
    if (hear(monotonic_now() + repeat_after)) {
      limit = monotonic_now() + most_silence;
    } else {
      sent = static_cast<std::size_t>(state_.received);  // a part was lost; repeat from there
    }
    if (monotonic_now() > limit) throw daemon_.silence();
  }
  check();
}

/// Waits for the end of the transfer on the bus. The status messages also tell the daemon that this
/// program still waits.
void FileTransfer::await_end() {
  Time limit = monotonic_now() + most_silence;
  Time ask_at = monotonic_now() + ask_every;
  while (state_.stage == "running") {
    progress_(static_cast<std::size_t>(state_.done), static_cast<std::size_t>(state_.total));
    if (hear(ask_at)) limit = monotonic_now() + most_silence;
    if (monotonic_now() > limit) throw daemon_.silence();
    if (monotonic_now() < ask_at) continue;
    ask_at = monotonic_now() + ask_every;
    send(message("status"));
  }
  check();
}

void FileTransfer::download(std::span<const std::byte> value) {
  if (value.size() > Transfers::most_bytes) {
    throw Failure{fmt::format("a file has at most {} bytes", Transfers::most_bytes), 1};
  }
  const AtEnd end{[this] { send(message("end")); }};
  begin("download", value.size());
  fill(value);
  await_end();
}

std::vector<std::byte> FileTransfer::upload(std::size_t limit) {
  const AtEnd end{[this] { send(message("end")); }};
  begin("upload", std::min(limit, Transfers::most_bytes));
  await_end();
  fetch();
  return std::move(value_);
}

void FileTransfer::fetch() {
  const auto total = static_cast<std::size_t>(state_.total);
  Time limit = monotonic_now() + most_silence;
  while (value_.size() < total) {
    const std::size_t before = value_.size();
    transfer_t more = message("more");
    more.offset = static_cast<std::int64_t>(before);
    more.total = static_cast<std::int64_t>(window);
    send(std::move(more));
    const std::size_t wanted = std::min(total, before + window);
    while (value_.size() < wanted && hear(monotonic_now() + repeat_after)) check();
    if (value_.size() != before) limit = monotonic_now() + most_silence;
    if (monotonic_now() > limit) throw daemon_.silence();
  }
}

}  // namespace takt
