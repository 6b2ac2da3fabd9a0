#include "master/linux/bus/diagnostic_socket.hpp"

#include <cerrno>
#include <cstring>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <string>
#include <sys/socket.h>

#include "master/linux/bus_name.hpp"
#include "master/linux/can/can_control.hpp"
#include "master/linux/can/can_frame.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"
#include "master/linux/message_batch.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_record.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {
namespace {

constexpr std::size_t news_batch_frames = 128;
constexpr int batches_a_poll = 32;
constexpr Time look_for_traffic_again = std::chrono::seconds{1};

FileDescriptor open_can(const std::string& interface) {
  FileDescriptor socket{::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)};
  const int on = 1;
  const int receive_buffer = 1 << 20;
  const can_err_mask_t errors = CAN_ERR_MASK;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return {};
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  setsockopt(socket.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return {};
  }
  return socket;
}

}  // namespace

struct DiagnosticSocket::State {
  State(BusName bus, const BusPlan& plan, const SentFrames& frames)
      : name{std::move(bus)}, sent{&frames}, watch{plan} {}

  BusName name;
  const SentFrames* sent;
  IntruderWatch watch;
  FileDescriptor socket;
  Time next_look{};
  HeardTraffic traffic;
  std::uint64_t lost_before = 0;  // lost on previous sockets
  MessageBatch<can_frame, news_batch_frames, can_control_bytes> can;
  MessageBatch<UnixBusRecord, news_batch_frames, 0> unix_bus;

  bool connect() {
    lost_before = traffic.lost;
    const auto address = unix_address(name.name);
    if (name.kind == BusName::Kind::can_interface) socket = open_can(name.name);
    if (name.kind == BusName::Kind::unix_path && address) socket = connect_unix(*address);
    return static_cast<bool>(socket);
  }
  int receive() noexcept {
    return name.kind == BusName::Kind::unix_path ? unix_bus.receive(socket.get(), news_batch_frames)
                                                 : can.receive(socket.get(), news_batch_frames);
  }
  void take_can(std::size_t i, Time offset, Time now, const OnFrame& on_frame);
  void take_unix(std::size_t i, const OnFrame& on_frame);
  void hear(const StampedFrame& frame, Origin origin, const OnFrame& on_frame);
};

void DiagnosticSocket::State::hear(const StampedFrame& frame, Origin origin,
                                   const OnFrame& on_frame) {
  ++traffic.frames;
  traffic.bits += static_cast<std::uint64_t>(WireTime::mean_bits(frame.frame));
  watch.on_frame(frame, origin);
  if (on_frame) on_frame(frame);
}

void DiagnosticSocket::State::take_can(std::size_t i, Time offset, Time now,
                                       const OnFrame& on_frame) {
  if (can.bytes(i) != CAN_MTU) return;
  const can_frame& raw = can.record(i);
  msghdr& header = can.header(i);
  const CanControl control = can_control_of(header);
  if (control.dropped) traffic.lost = lost_before + *control.dropped;
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    ++traffic.error_frames;
    return;
  }
  const Time when = monotonic_stamp(control.realtime, offset, now);
  const Origin origin =
      (header.msg_flags & MSG_DONTROUTE) != 0 ? Origin::this_machine : Origin::wire;
  hear({.frame = from_kernel(raw.can_id, raw.can_dlc, raw.data), .when = when}, origin, on_frame);
}

void DiagnosticSocket::State::take_unix(std::size_t i, const OnFrame& on_frame) {
  const UnixBusRecord& record = unix_bus.record(i);
  if (unix_bus.bytes(i) == 0) socket.reset();  // end of file: the hub has ended
  if (unix_bus.bytes(i) != sizeof(UnixBusRecord) || !valid(record)) return;
  traffic.lost = lost_before + record.lost;
  const Frame frame = from_kernel(record.can_id, record.length, record.data);
  hear({.frame = frame, .when = Time{record.when}}, Origin::this_machine, on_frame);
}

DiagnosticSocket::DiagnosticSocket(std::unique_ptr<State> state) noexcept
    : state_{std::move(state)} {}
DiagnosticSocket::DiagnosticSocket(DiagnosticSocket&&) noexcept = default;
DiagnosticSocket& DiagnosticSocket::operator=(DiagnosticSocket&&) noexcept = default;
DiagnosticSocket::~DiagnosticSocket() = default;

std::expected<DiagnosticSocket, BusError> DiagnosticSocket::open(std::string_view bus,
                                                                 const BusPlan& plan,
                                                                 const SentFrames& sent) {
  auto state = std::make_unique<State>(BusName::parse(bus), plan, sent);
  if (!state->connect()) {
    std::string message{bus};
    message += ": the diagnostic socket can't be opened: ";
    return std::unexpected{BusError{message + std::strerror(errno), errno}};
  }
  state->watch.on_drained(sent, monotonic_now());
  return DiagnosticSocket{std::move(state)};
}

int DiagnosticSocket::fd() const noexcept { return state_->socket.get(); }

void DiagnosticSocket::poll(const OnFrame& on_frame) {
  State& state = *state_;
  const Time start = monotonic_now();
  if (!state.socket) {
    if (start < state.next_look) return;
    state.next_look = start + look_for_traffic_again;
    if (!state.connect()) return;
  }
  for (int batch = 0; batch < batches_a_poll && state.socket; ++batch) {
    const int got = state.receive();
    if (got < 0) {
      const bool alive = errno == EAGAIN || errno == EINTR || errno == ENETDOWN;
      if (!alive) state.socket.reset();
      if (alive) state.watch.on_drained(*state.sent, start);
      return;
    }
    const Time offset = realtime_offset();
    const Time now = monotonic_now();
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
      if (state.name.kind == BusName::Kind::unix_path) {
        state.take_unix(i, on_frame);
      } else {
        state.take_can(i, offset, now, on_frame);
      }
    }
  }
}

bool DiagnosticSocket::take(Event& event) { return state_->watch.take(event); }

HeardTraffic DiagnosticSocket::traffic() const noexcept { return state_->traffic; }

}  // namespace takt
