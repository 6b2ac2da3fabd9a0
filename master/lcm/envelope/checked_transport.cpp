#include "master/lcm/envelope/checked_transport.hpp"

#include <algorithm>
#include <utility>

#include "master/lcm/channel_names.hpp"

namespace takt {
CheckedTransport::CheckedTransport(std::unique_ptr<Transport> inner, WatchedKeyFile keys,
                                   std::function<Time()> wall)
    : inner_{std::move(inner)}, keys_{std::move(keys)}, wall_{std::move(wall)} {
  guard_.set_keys(keys_.keys());
  inner_->subscribe(any_bus("SIGNED"));
}

void CheckedTransport::subscribe(const std::string& pattern) {
  if (auto parsed = ChannelPattern::parse(pattern)) patterns_.push_back(std::move(*parsed));
}

void CheckedTransport::serve(const MessageHandler& handler) {
  reread_keys();
  inner_->serve([&](std::string_view channel, Bytes data) { take(channel, data, handler); });
}

/// Reads a changed key file. If the file cannot be read, the previous keys stay in use.
void CheckedTransport::reread_keys() {
  const Time now = wall_();
  if (now >= next_look_ - look_pause && now < next_look_) return;
  next_look_ = now + look_pause;
  if (const auto read = keys_.reread(); read && *read) guard_.set_keys(keys_.keys());
}

void CheckedTransport::take(std::string_view channel, Bytes data, const MessageHandler& handler) {
  const bool is_signed = !bus_of_channel(channel, "SIGNED").empty();
  const auto envelope =
      is_signed ? guard_.open(data, wall_()) : std::unexpected{EnvelopeFault::damaged};
  if (!envelope) {
    ++refused_;
    return;
  }
  const auto hears = [&](const ChannelPattern& pattern) {
    return pattern.match(envelope->channel);
  };
  if (std::ranges::none_of(patterns_, hears)) return;
  handler(envelope->channel, std::as_bytes(std::span{envelope->data}));
}

}  // namespace takt
