#include "apps/takt/service/sdo_direct.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "apps/command_line/interrupt.hpp"
#include "apps/takt/service/send_all.hpp"
#include "master/core/request.hpp"
#include "master/core/sdo/sdo_client.hpp"
#include "master/gateway/command/requests.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

/// Runs an SDO client until it has a result. The channel receives every frame on the bus; only the
/// responses of the node go to the client.
class Drive {
 public:
  /// `limit` is the greatest number of bytes of an uploaded file; 0 means that no file is uploaded.
  Drive(SdoClient& client, FrameChannel& channel, const std::string& bus, std::size_t limit = 0)
      : client_{client}, channel_{channel}, bus_{bus}, limit_{limit} {}

  /// Returns the number of bytes. Throws a Failure if the transfer failed.
  std::size_t run(std::size_t total, const Progress& progress) {
    for (;;) {
      if (Interrupt::asked()) client_.cancel();
      if (progress) progress(client_.progress(), total != 0 ? total : client_.announced());
      if (!send()) throw Failure{"a frame could not be sent on " + bus_};
      if (const auto result = client_.take_result()) return reported(*result);
      receive();
    }
  }

 private:
  std::size_t reported(const SdoResult& result) {
    send();  // sends the abort or the last confirmation
    if (result.fault == SdoFault::none) return result.size;
    if (Interrupt::asked()) throw Failure{"interrupted; the transfer was aborted", 1};
    if (result.fault == SdoFault::too_long && limit_ != 0) {
      throw Failure{
          fmt::format("the object is longer than the limit of {} bytes (--limit)", limit_), 1,
          result.abort_code};
    }
    throw Failure{fault_text(result.fault, result.abort_code,
                             {.late = client_.lateness(), .answered = client_.answered()}),
                  1, result.abort_code};
  }

  /// Sends the client's frames. Returns false if no node acknowledges them.
  bool send() {
    client_.on_time(monotonic_now(), out_);
    const bool sent =
        send_all(channel_, out_.frames(), [this](const Frame& frame) { take(frame); });
    if (sent) out_.clear();
    return sent;
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

FrameChannel SdoDirect::open() const {
  return value_or_fail(FrameChannel::open(bus_, BusMember::guest), 3);
}

std::vector<std::byte> SdoDirect::upload(ObjectKey object) {
  FrameChannel channel = open();
  std::vector<std::byte> buffer(request_bytes);
  SdoClient client{node_};
  client.upload(object, buffer, timeout_, SdoMode::plain);
  buffer.resize(Drive{client, channel, bus_}.run(0, {}));
  return buffer;
}

/// If a device does not stop sending segments, the transfer ends with an abort when the buffer is
/// full.
std::vector<std::byte> SdoDirect::upload(ObjectKey object, std::size_t limit,
                                         const Progress& progress) {
  FrameChannel channel = open();
  std::vector<std::byte> buffer(limit);
  SdoClient client{node_};
  client.upload(object, buffer, timeout_, SdoMode::block);
  buffer.resize(Drive{client, channel, bus_, limit}.run(0, progress));
  return buffer;
}

void SdoDirect::download(ObjectKey object, std::span<const std::byte> value,
                         const Progress& progress) {
  FrameChannel channel = open();
  SdoClient client{node_};
  client.download(object, value, timeout_);
  Drive{client, channel, bus_}.run(value.size(), progress);
}

}  // namespace takt
