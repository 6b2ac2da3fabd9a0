#include "master/lcm/envelope/secured_transport.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "eds_parser/lcm/lcm_channel.hpp"
#include "master/lcm/messages.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

constexpr std::size_t most_opened = 64;

}  // namespace

SecuredTransport::SecuredTransport(Transport& inner, const Clocks& clocks, WatchedKeyFile keys,
                                   Options options)
    : inner_{inner},
      clocks_{clocks},
      keys_{std::move(keys)},
      options_{std::move(options)},
      secured_channel_{channel_name(options_.bus, "SECURED")},
      signed_channel_{channel_name(options_.bus, "SIGNED")},
      guard_{options_.session} {
  use_keys();
}

/// Signs messages with the first key of the file from now on.
void SecuredTransport::use_keys() {
  guard_.set_keys(keys_.keys());
  if (options_.signs) seal_.emplace(keys_.keys().front(), random_number());
}

bool SecuredTransport::publish(const std::string& channel, std::span<const std::byte> data) {
  const bool good = inner_.publish(channel, data);
  if (!seal_ || !inner_.wanted(signed_channel_)) return good;
  const Time wall = clocks_.now() + clocks_.wall_offset();
  return inner_.publish(signed_channel_, seal_->seal(channel, data, options_.session, wall)) &&
         good;
}

bool SecuredTransport::is_guarded(std::string_view channel) const noexcept {
  return std::ranges::find(options_.guarded, channel) != options_.guarded.end();
}

void SecuredTransport::serve(const MessageHandler& handler) {
  reread_keys(clocks_.now());
  inner_.serve([&](std::string_view channel, Bytes data) { take(channel, data, handler); });
}

void SecuredTransport::reread_keys(Time now) {
  if (now < next_look_) return;
  next_look_ = now + look_pause;
  const auto read = keys_.reread();
  if (!read) return;
  if (*read) {
    use_keys();
    options_.say(keys_.path() + " has changed: " + std::to_string(keys_.keys().size()) +
                 " keys are valid from now on");
  } else {
    options_.say(read->error() + "; the previous keys stay valid");
  }
}

void SecuredTransport::take(std::string_view channel, Bytes data, const MessageHandler& handler) {
  if (channel == secured_channel_) {
    const Time now = clocks_.now();
    if (is_echo(data, now)) return;
    const auto envelope = guard_.open(data, now + clocks_.wall_offset());
    if (!envelope) return refuse("an envelope was refused: " + std::string{text(envelope.error())});
    if (!is_guarded(envelope->channel)) {
      return refuse("an envelope was refused: taktd accepts no messages on channel '" +
                    printable_text(std::string_view{envelope->channel}.substr(0, 63)) + "'");
    }
    if (opened_.size() == most_opened) opened_.pop_front();
    const Bytes mac = data.last(mac_bytes);
    opened_.push_back({.mac = {mac.begin(), mac.end()}, .when = now});
    return handler(envelope->channel, std::as_bytes(std::span{envelope->data}));
  }
  if (is_guarded(channel)) {
    return refuse("a message on " + std::string{channel} +
                  " was refused: this bus has `keys`, and the message came without an envelope");
  }
  handler(channel, data);
}

/// Returns true if the same envelope arrived a moment ago by another path (multicast and the hub).
/// Such a copy is dropped without a report.
bool SecuredTransport::is_echo(Bytes envelope, Time now) {
  while (!opened_.empty() && now - opened_.front().when > echo_limit) opened_.pop_front();
  if (envelope.size() < mac_bytes) return false;
  const Bytes mac = envelope.last(mac_bytes);
  return std::ranges::any_of(opened_,
                             [&](const Opened& one) { return std::ranges::equal(one.mac, mac); });
}

void SecuredTransport::refuse(const std::string& what) {
  const auto kept_back = reported_.allow(what, clocks_.now());
  if (kept_back) options_.say(with_kept_back(what, *kept_back));
}

}  // namespace takt
