#include "master/linux/unix_bus/unix_bus.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sys/socket.h>
#include <system_error>

#include "master/linux/file_descriptor.hpp"
#include "master/linux/message_batch.hpp"
#include "master/linux/port_wait.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_hub.hpp"
#include "master/linux/unix_bus/unix_bus_record.hpp"

namespace takt {
namespace {

constexpr std::size_t batch_frames = 256;
constexpr Time look_again = std::chrono::milliseconds{10};
constexpr Time open_limit = std::chrono::seconds{2};
// A guest waits this long for a new host, which takes over within 20 ms.
constexpr Time connect_timeout = std::chrono::milliseconds{60};

}  // namespace

struct UnixBusPort::State {
  FileDescriptor socket;
  std::optional<UnixBusHub> hub;       // empty for an end of a socket pair and for a guest
  std::optional<sockaddr_un> address;  // empty for an end of a socket pair
  std::optional<canid_t> sync_id;
  bool echoes = false;
  Time spin{};
  SentFrames* sent = nullptr;
  Time next_look{};
  std::uint32_t lost_before = 0;  // frames lost on earlier connections
  PortCondition condition;
  MessageBatch<UnixBusRecord, batch_frames, 0> in;
  MessageBatch<UnixBusRecord, batch_frames, 0> out;

  void note(int error) noexcept;
  void disconnected() noexcept;
  void look_for_hub() noexcept;
  bool connect_until(Time limit) noexcept;
  void echo(std::size_t count) noexcept;
  bool take(std::size_t i, StampedFrame& frame) noexcept;
};

void UnixBusPort::State::disconnected() noexcept {
  socket.reset();
  lost_before = condition.receive_overruns;
  condition.interface_down = true;
  next_look = monotonic_now() + look_again;
}

void UnixBusPort::State::note(int error) noexcept {
  const bool full = error == EAGAIN || error == ENOBUFS;
  condition.last_error = full ? ENOBUFS : ENETDOWN;
  if (!full) disconnected();
}

void UnixBusPort::State::look_for_hub() noexcept {
  const Time now = monotonic_now();
  if (!address || now < next_look) return;
  next_look = now + look_again;
  socket = connect_unix(*address);
  condition.interface_down = !socket;
}

/// Returns received frames to their sender as echoes. A lost echo does no harm.
void UnixBusPort::State::echo(std::size_t count) noexcept {
  const std::int64_t now = monotonic_now().count();
  for (std::size_t i = 0; i < count; ++i) {
    if (in.record(i).when == 0) in.record(i).when = now;
    out.record(i) = in.record(i);
    out.record(i).own = 1;
  }
  out.send(socket.get(), 0, count);
}

/// Converts message i of the batch. Returns false if it is not a frame, or if it is only for the
/// port itself (an echo).
bool UnixBusPort::State::take(std::size_t i, StampedFrame& frame) noexcept {
  const UnixBusRecord& record = in.record(i);
  if (in.bytes(i) != sizeof(UnixBusRecord) || !valid(record)) return false;
  condition.receive_overruns = lost_before + record.lost;
  const Time when = record.when != 0 ? Time{record.when} : monotonic_now();
  if (record.own != 0) {
    if (sync_id == record.can_id) condition.last_sync_echo = when;
    return false;
  }
  frame = {.frame = from_kernel(record.can_id, record.length, record.data), .when = when};
  return true;
}

UnixBusPort::UnixBusPort(std::unique_ptr<State> state) noexcept : state_{std::move(state)} {}
UnixBusPort::UnixBusPort(UnixBusPort&&) noexcept = default;
UnixBusPort& UnixBusPort::operator=(UnixBusPort&&) noexcept = default;
UnixBusPort::~UnixBusPort() = default;

/// Connects, and retries until `limit` if nobody listens (yet).
bool UnixBusPort::State::connect_until(Time limit) noexcept {
  while (!(socket = connect_unix(*address))) {
    if (monotonic_now() > limit) return false;
    takt::sleep_until(monotonic_now() + std::chrono::milliseconds{1});
  }
  return true;
}

std::expected<UnixBusPort, BusError> UnixBusPort::open(const UnixBusOptions& options) {
  auto state = std::make_unique<State>();
  state->address = unix_address(options.path);
  const bool guest = options.member == BusMember::guest && state->address &&
                     state->connect_until(monotonic_now() + connect_timeout);
  if (!guest) {
    auto hub = UnixBusHub::join(options.path);
    if (!hub) return std::unexpected{hub.error()};
    state->hub = std::move(*hub);
  }
  state->spin = options.spin;
  state->sent = options.sent;
  if (options.sync_cob_id) state->sync_id = kernel_id(Frame{.id = *options.sync_cob_id});
  // Another process may hold the lock but not listen yet.
  if (!guest && !state->connect_until(monotonic_now() + open_limit)) {
    const int error = errno;
    return std::unexpected{
        BusError{"unix:" + options.path + ": cannot connect: " + std::strerror(error), error}};
  }
  return UnixBusPort{std::move(state)};
}

std::pair<UnixBusPort, UnixBusPort> make_socket_pair_bus(std::optional<CobId> sync_cob_id,
                                                         Time spin) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::system_error{errno, std::generic_category(), "socketpair"};
  }
  auto master = std::make_unique<UnixBusPort::State>();
  auto devices = std::make_unique<UnixBusPort::State>();
  master->socket.reset(ends[0]);
  devices->socket.reset(ends[1]);
  master->spin = spin;
  if (sync_cob_id) master->sync_id = kernel_id(Frame{.id = *sync_cob_id});
  devices->echoes = true;
  return {UnixBusPort{std::move(master)}, UnixBusPort{std::move(devices)}};
}

void UnixBusPort::sleep_precisely_until(Time until) noexcept {
  takt::sleep_precisely_until(until, state_->spin);
}

bool UnixBusPort::wait_frame(Time until) noexcept {
  if (state_->condition.interface_down) return wait_to_look_again(look_again, until);
  return wait_for_frame(state_->socket.get(), until);
}

std::size_t UnixBusPort::receive(std::span<StampedFrame> in) noexcept {
  State& state = *state_;
  if (state.condition.interface_down) state.look_for_hub();
  if (state.condition.interface_down || in.empty()) return 0;
  std::size_t taken = 0;
  for (bool more = true; more;) {
    const std::size_t room = std::min(in.size() - taken, batch_frames);
    const int got = state.in.receive(state.socket.get(), room);
    if (got < 0 && errno != EAGAIN && errno != EINTR) state.note(errno);
    if (got <= 0) break;
    const auto count = static_cast<std::size_t>(got);
    state.condition.since_1970 = realtime_offset();
    if (state.echoes) state.echo(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (state.take(i, in[taken])) ++taken;
    }
    const bool ended = state.in.bytes(count - 1) == 0;
    if (ended) state.note(ECONNRESET);
    more = !ended && count == room && taken < in.size();
  }
  return taken;
}

SendResult UnixBusPort::send(std::span<const Frame> out) noexcept {
  State& state = *state_;
  if (state.condition.interface_down) return {.sent = 0, .error = ENETDOWN};
  if (state.sent != nullptr) state.sent->add(out);
  const auto fill = [now = monotonic_now().count()](UnixBusRecord& record, const Frame& frame) {
    record = to_record(frame);
    record.when = now;  // a hub overwrites this with its own time
  };
  SendResult result{.sent = state.out.send_all(state.socket.get(), out, fill)};
  if (result.sent < out.size()) {
    state.note(errno);
    result.error = state.condition.last_error;
  }
  if (state.sent != nullptr) state.sent->take_back(out.subspan(result.sent));
  return result;
}

PortCondition UnixBusPort::condition() const noexcept { return state_->condition; }

static_assert(Port<UnixBusPort>);

}  // namespace takt
