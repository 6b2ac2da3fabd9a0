#include "master/linux/can/socket_can.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <utility>

#include "master/linux/can/can_control.hpp"
#include "master/linux/can/can_error_frame.hpp"
#include "master/linux/can/can_filters.hpp"
#include "master/linux/can/can_frame.hpp"
#include "master/linux/file_descriptor.hpp"
#include "master/linux/message_batch.hpp"
#include "master/linux/port_wait.hpp"

namespace takt {
namespace {

constexpr std::size_t can_batch_frames = 256;
constexpr Time look_at_interface_again = std::chrono::milliseconds{50};

BusError error_of(const std::string& interface, const std::string& what, int error) {
  return {interface + ": " + what + ": " + std::strerror(error), error};
}

bool set_option(int fd, int level, int option, int value) noexcept {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

/// Returns true if the interface is missing, down or was replaced, so that nothing works until it
/// is back.
constexpr bool means_down(int error) noexcept {
  return error == ENETDOWN || error == ENODEV || error == ENXIO || error == ENETUNREACH;
}

}  // namespace

struct SocketCanPort::State {
  FileDescriptor fd;
  ifreq request{};  // holds the name of the interface
  std::vector<can_filter> filters;
  std::optional<canid_t> sync_id;
  Time spin{};
  SentFrames* sent = nullptr;
  Time next_look{};
  PortCondition condition;
  std::uint32_t dropped = 0;  // part of condition.receive_overruns that the kernel dropped
  MessageBatch<can_frame, can_batch_frames, can_control_bytes> in;
  MessageBatch<can_frame, can_batch_frames, 0> out;

  bool bind_interface() noexcept;
  void note(int error) noexcept;
  void look_for_interface() noexcept;
  std::size_t fetch(std::size_t most) noexcept;
  bool take(std::size_t i, Time offset, Time now, StampedFrame& frame) noexcept;
};

/// Sets the filters and binds the socket to the interface. If the interface is deleted, both are
/// lost. The function may be called again for the new interface.
bool SocketCanPort::State::bind_interface() noexcept {
  ifreq index = request;
  if (ioctl(fd.get(), SIOCGIFINDEX, &index) != 0) return false;
  const auto bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (setsockopt(fd.get(), SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) != 0) return false;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index.ifr_ifindex;
  return bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

void SocketCanPort::State::note(int error) noexcept {
  condition.last_error = error;
  if (!means_down(error)) return;
  if (!condition.interface_down) next_look = monotonic_now() + look_at_interface_again;
  condition.interface_down = true;
}

void SocketCanPort::State::look_for_interface() noexcept {
  const Time now = monotonic_now();
  if (now < next_look) return;
  next_look = now + look_at_interface_again;
  ifreq flags = request;
  if (ioctl(fd.get(), SIOCGIFFLAGS, &flags) != 0 || (flags.ifr_flags & IFF_UP) == 0) return;
  if (!bind_interface()) return;
  int stale = 0;  // the error of the lost interface, if no call has reported it yet
  socklen_t size = sizeof stale;
  getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &stale, &size);
  condition.interface_down = false;
  condition.bus_off = false;  // a controller starts in the state error-active
  condition.error_passive = false;
}

/// Returns the number of messages in the next batch.
std::size_t SocketCanPort::State::fetch(std::size_t most) noexcept {
  const int got = in.receive(fd.get(), most);
  if (got < 0 && errno != EAGAIN && errno != EINTR) note(errno);
  return got < 0 ? 0 : static_cast<std::size_t>(got);
}

/// Converts message i of the batch. Returns false if the message is only for the port itself (an
/// error frame, or the echo of a frame that this port has sent).
bool SocketCanPort::State::take(std::size_t i, Time offset, Time now,
                                StampedFrame& frame) noexcept {
  if (in.bytes(i) != CAN_MTU) return false;
  const can_frame& raw = in.record(i);
  msghdr& header = in.header(i);
  const CanControl control = can_control_of(header);
  if (control.dropped) {
    condition.receive_overruns += *control.dropped - std::exchange(dropped, *control.dropped);
  }
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    apply_error_frame(raw, condition);
    return false;
  }
  const Time when = monotonic_stamp(control.realtime, offset, now);
  if (header.msg_flags & MSG_CONFIRM) {
    if (sync_id == raw.can_id) condition.last_sync_echo = when;
    condition.bus_off = false;  // an echo proves that the controller is not bus-off
    return false;
  }
  frame = {.frame = from_kernel(raw.can_id, raw.can_dlc, raw.data), .when = when};
  return true;
}

SocketCanPort::SocketCanPort(std::unique_ptr<State> state) noexcept : state_{std::move(state)} {}
SocketCanPort::SocketCanPort(SocketCanPort&&) noexcept = default;
SocketCanPort& SocketCanPort::operator=(SocketCanPort&&) noexcept = default;
SocketCanPort::~SocketCanPort() = default;

std::expected<SocketCanPort, BusError> SocketCanPort::open(const SocketCanOptions& options) {
  const std::string& name = options.interface;
  auto state = std::make_unique<State>();
  if (name.empty() || name.size() >= IFNAMSIZ) {
    return std::unexpected{BusError{name + ": this is not an interface name", EINVAL}};
  }
  std::memcpy(state->request.ifr_name, name.c_str(), name.size() + 1);
  state->filters = options.filters;
  state->spin = options.spin;
  state->sent = options.sent;
  if (options.sync_cob_id) state->sync_id = kernel_id(Frame{.id = *options.sync_cob_id});

  state->fd.reset(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!state->fd) {
    return std::unexpected{error_of(
        name, "this kernel has no CAN (try: modprobe can-raw, or --bus unix:/tmp/bus)", errno)};
  }
  const int fd = state->fd.get();
  const can_err_mask_t errors = state_error_classes;
  if (!set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1) ||
      !set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1) ||
      !set_option(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, options.sync_cob_id ? 1 : 0) ||
      setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0) {
    return std::unexpected{error_of(name, "a socket option can't be set", errno)};
  }
  // The receive buffer has to hold the frames that arrive while this thread is stalled. Only a
  // privileged process can exceed net.core.rmem_max.
  if (!set_option(fd, SOL_SOCKET, SO_RCVBUFFORCE, 1 << 20)) {
    set_option(fd, SOL_SOCKET, SO_RCVBUF, 1 << 20);
  }
  ifreq flags = state->request;
  if (ioctl(fd, SIOCGIFFLAGS, &flags) != 0) {
    return std::unexpected{
        error_of(name, "the interface does not exist (ip -br link lists the interfaces)", errno)};
  }
  if (!state->bind_interface())
    return std::unexpected{error_of(name, "this is not a CAN interface", errno)};
  if ((flags.ifr_flags & IFF_UP) == 0) {
    return std::unexpected{error_of(name,
                                    "the interface is down (ip link set " + name +
                                        " up, for hardware with type can bitrate ...)",
                                    ENETDOWN)};
  }
  return SocketCanPort{std::move(state)};
}

std::expected<SocketCanPort, BusError> SocketCanPort::open(const std::string& interface,
                                                           const BusPlan& plan, Time spin,
                                                           SentFrames* sent) {
  SocketCanOptions options{
      .interface = interface, .filters = filters_for(plan), .spin = spin, .sent = sent};
  if (plan.cycle.makes_sync()) options.sync_cob_id = plan.cycle.sync_cob_id;
  return open(options);
}

void SocketCanPort::sleep_precisely_until(Time until) noexcept {
  takt::sleep_precisely_until(until, state_->spin);
}

bool SocketCanPort::wait_frame(Time until) noexcept {
  if (state_->condition.interface_down) return wait_to_look_again(look_at_interface_again, until);
  return wait_for_frame(state_->fd.get(), until);
}

std::size_t SocketCanPort::receive(std::span<StampedFrame> in) noexcept {
  State& state = *state_;
  if (state.condition.interface_down) state.look_for_interface();
  std::size_t taken = 0;
  for (bool more = true; more;) {
    const std::size_t room = std::min(in.size() - taken, can_batch_frames);
    const std::size_t got = state.fetch(room);
    if (got == 0) break;
    const Time offset = realtime_offset();
    state.condition.since_1970 = offset;
    const Time now = monotonic_now();
    for (std::size_t i = 0; i < got; ++i) {
      if (state.take(i, offset, now, in[taken])) ++taken;
    }
    more = got == room && taken < in.size();
  }
  return taken;
}

SendResult SocketCanPort::send(std::span<const Frame> out) noexcept {
  State& state = *state_;
  if (state.condition.interface_down) return {.sent = 0, .error = state.condition.last_error};
  if (state.sent != nullptr) state.sent->add(out);
  const auto fill = [](can_frame& record, const Frame& frame) { record = to_kernel(frame); };
  SendResult result{.sent = state.out.send_all(state.fd.get(), out, fill)};
  if (result.sent < out.size()) {
    result.error = errno == EAGAIN ? ENOBUFS : errno;
    state.note(result.error);
  }
  if (state.sent != nullptr) state.sent->take_back(out.subspan(result.sent));
  return result;
}

PortCondition SocketCanPort::condition() const noexcept { return state_->condition; }

static_assert(Port<SocketCanPort>);

}  // namespace takt
