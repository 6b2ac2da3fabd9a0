#include "apps/takt/service/sdo_direct.hpp"

#include <algorithm>

#include "apps/command_line/interrupt.hpp"
#include "master/core/request.hpp"
#include "master/core/sdo/sdo_client.hpp"
#include "master/gateway/command/requests.hpp"
#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

// After this time with a full transmit queue, no node acknowledges the frames.
constexpr Time longest_jam = std::chrono::seconds{2};

/// Runs an SDO client until it has a result. The channel receives every frame on the bus; only the
/// responses of the node go to the client.
class Drive {
 public:
  /// `limit` is the greatest number of bytes of an uploaded file; 0 means that no file is uploaded.
  Drive(SdoClient& client, FrameChannel& channel, const std::string& bus, std::size_t limit = 0)
      : client_{client}, channel_{channel}, bus_{bus}, limit_{limit} {}

  std::expected<std::size_t, LiveError> run(std::size_t total, const Progress& progress) {
    for (;;) {
      if (Interrupt::asked()) client_.cancel();
      if (progress) progress(client_.progress(), total != 0 ? total : client_.announced());
      if (!send()) return std::unexpected{LiveError{"a frame could not be sent on " + bus_, 3}};
      if (const auto result = client_.take_result()) return reported(*result);
      receive();
    }
  }

 private:
  std::expected<std::size_t, LiveError> reported(const SdoResult& result) {
    send();  // sends the abort or the last confirmation
    if (result.fault == SdoFault::none) return result.size;
    if (Interrupt::asked()) {
      return std::unexpected{LiveError{"interrupted; the transfer was aborted", 1}};
    }
    std::string why = fault_text(result.fault, result.abort_code,
                                 {.late = client_.lateness(), .answered = client_.answered()});
    if (result.fault == SdoFault::too_long && limit_ != 0) {
      why = "the object is longer than the limit of " + std::to_string(limit_) + " bytes (--limit)";
    }
    return std::unexpected{LiveError{std::move(why), 1, result.abort_code}};
  }

  /// Sends the client's frames. Waits if the transmit queue is full, because a block is longer than
  /// the queue of an interface. Returns false if there is no room for longest_jam.
  bool send() {
    client_.on_time(monotonic_now(), out_);
    for (const Time limit = monotonic_now() + longest_jam; !out_.empty();) {
      if (channel_.send(out_.frames()).sent == out_.frames().size()) break;
      if (monotonic_now() > limit) return false;
      StampedFrame frame;
      if (channel_.receive(frame, std::chrono::milliseconds{1})) take(frame.frame);
    }
    out_.clear();
    return true;
  }

  void receive() {
    StampedFrame frame;
    const Time pause = std::clamp<Time>(client_.deadline() - monotonic_now(), Time{0},
                                        std::chrono::milliseconds{100});
    if (channel_.receive(frame, pause)) take(frame.frame);
  }

  void take(const Frame& frame) {
    if (frame.id == client_.channel().answer && !frame.rtr) {
      client_.on_frame(frame, monotonic_now());
    }
  }

  SdoClient& client_;
  FrameChannel& channel_;
  const std::string& bus_;
  std::size_t limit_;
  Outbox out_;
};

}  // namespace

std::expected<std::vector<std::byte>, LiveError> SdoDirect::upload(ObjectKey object) {
  auto channel = FrameChannel::open(bus_, BusMember::guest);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  std::vector<std::byte> buffer(request_bytes);
  SdoClient client{node_};
  client.upload(object, buffer, timeout_, SdoMode::plain);
  const auto size = Drive{client, *channel, bus_}.run(0, {});
  if (!size) return std::unexpected{size.error()};
  buffer.resize(*size);
  return buffer;
}

/// If a device does not stop sending segments, the transfer ends with an abort when the buffer is
/// full.
std::expected<std::vector<std::byte>, LiveError> SdoDirect::upload(ObjectKey object,
                                                                   std::size_t limit,
                                                                   const Progress& progress) {
  auto channel = FrameChannel::open(bus_, BusMember::guest);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  std::vector<std::byte> buffer(limit);
  SdoClient client{node_};
  client.upload(object, buffer, timeout_, SdoMode::block);
  Drive drive{client, *channel, bus_, limit};
  const auto size = drive.run(0, progress);
  if (!size) return std::unexpected{size.error()};
  buffer.resize(*size);
  return buffer;
}

std::expected<void, LiveError> SdoDirect::download(ObjectKey object,
                                                   std::span<const std::byte> value,
                                                   Progress progress) {
  auto channel = FrameChannel::open(bus_, BusMember::guest);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  SdoClient client{node_};
  client.download(object, value, timeout_);
  const auto size = Drive{client, *channel, bus_}.run(value.size(), progress);
  if (!size) return std::unexpected{size.error()};
  return {};
}

}  // namespace takt
