#include "apps/takt/sdo_direct.hpp"

#include <algorithm>

#include "master/core/sdo_client.hpp"
#include "master/gateway/requests.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/frame_channel.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

constexpr std::size_t largest_value = 16 << 20;

/// Everything on the bus arrives here; only the answers of `node` are for the client.
std::expected<std::size_t, LiveError> run(SdoClient& client, NodeId node, FrameChannel& channel,
                                          const std::string& bus) {
  const CobId answers = sdo_answer_cob_id(node);
  Outbox out;
  for (;;) {
    if (const auto result = client.take_result()) {
      if (result->fault == SdoFault::none) return result->size;
      return std::unexpected{LiveError{fault_text(result->fault, result->abort_code), 1}};
    }
    client.on_time(monotonic_now(), out);
    if (channel.send(out.frames()).sent != out.frames().size()) {
      return std::unexpected{LiveError{"a frame could not be sent on " + bus, 3}};
    }
    out.clear();
    StampedFrame frame;
    const Time pause = std::clamp<Time>(client.deadline() - monotonic_now(), Time{0},
                                        std::chrono::milliseconds{100});
    if (!channel.receive(frame, pause)) continue;
    if (frame.frame.id == answers && !frame.frame.rtr)
      client.on_frame(frame.frame, monotonic_now());
  }
}

}  // namespace

std::expected<std::vector<std::byte>, LiveError> SdoDirect::upload(ObjectKey object) {
  auto channel = FrameChannel::open(bus_);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  std::vector<std::byte> buffer(largest_value);
  SdoClient client{node_};
  client.upload(object, buffer, timeout_);
  const auto size = run(client, node_, *channel, bus_);
  if (!size) return std::unexpected{size.error()};
  buffer.resize(*size);
  return buffer;
}

std::expected<void, LiveError> SdoDirect::download(ObjectKey object,
                                                   std::span<const std::byte> value) {
  auto channel = FrameChannel::open(bus_);
  if (!channel) return std::unexpected{LiveError{channel.error().message, 3}};
  SdoClient client{node_};
  client.download(object, value, timeout_);
  const auto size = run(client, node_, *channel, bus_);
  if (!size) return std::unexpected{size.error()};
  return {};
}

}  // namespace takt
