#include "master/lcm/envelope/envelope.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <sodium.h>
#include <utility>

#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

constexpr std::int16_t envelope_schema = 1;
using Mac = std::array<std::uint8_t, mac_bytes>;

/// Returns the MAC over all bytes of an encoded envelope except the MAC itself, which comes last.
Mac mac_of(Bytes encoded, const EnvelopeKey& key) noexcept {
  Mac mac{};
  ::crypto_generichash(mac.data(), mac.size(), octets(encoded).data(), encoded.size() - mac_bytes,
                       key.secret.data(), key.secret.size());
  return mac;
}

bool has_mac(Bytes encoded, const Mac& mac) noexcept {
  return ::sodium_memcmp(encoded.last(mac_bytes).data(), mac.data(), mac.size()) == 0;
}

}  // namespace

std::string_view text(EnvelopeFault fault) noexcept {
  static constexpr std::string_view names[]{
      "its bytes are damaged, or it has another version",
      "it has another schema",
      "the key file of the daemon has no key of this name",
      "its MAC is wrong: it was forged or altered, or its sender has another secret",
      "it is for another session of taktd (a replayed log, or taktd has restarted)",
      "its time is more than 1 s in the past",
      "its time is more than 1 s in the future",
      "it is repeated or out of order: the counter of this sender was higher already",
      "too many senders are active at once"};
  return name_of(fault, names);
}

EnvelopeSeal::EnvelopeSeal(EnvelopeKey key, std::int64_t instance) : key_{std::move(key)} {
  envelope_.schema = envelope_schema;
  envelope_.instance = instance;
  envelope_.key = key_.name;
}

Bytes EnvelopeSeal::seal(std::string_view channel, Bytes message, std::int64_t session, Time wall) {
  envelope_.utime = wall / std::chrono::microseconds{1};
  envelope_.session = session;
  ++envelope_.counter;
  envelope_.channel = channel;
  envelope_.data.assign(octets(message).begin(), octets(message).end());
  envelope_.size = static_cast<std::int32_t>(message.size());
  const Bytes encoded = encode(envelope_, buffer_);
  const Mac mac = mac_of(encoded, key_);
  std::ranges::copy(std::as_bytes(std::span{mac}), buffer_.end() - mac_bytes);
  return encoded;
}

std::expected<envelope_t, EnvelopeFault> EnvelopeGuard::open(Bytes bytes, Time wall) {
  if (bytes.size() > most_bytes) return std::unexpected{EnvelopeFault::damaged};
  auto envelope = decode<envelope_t>(bytes);
  if (!envelope) return std::unexpected{EnvelopeFault::damaged};
  if (envelope->schema != envelope_schema) return std::unexpected{EnvelopeFault::other_schema};
  const auto key = std::ranges::find(keys_, envelope->key, &EnvelopeKey::name);
  if (key == keys_.end()) return std::unexpected{EnvelopeFault::unknown_key};
  if (!has_mac(bytes, mac_of(bytes, *key))) return std::unexpected{EnvelopeFault::forged};
  // The MAC proves that a holder of a key has made this envelope.
  if (session_ && envelope->session != *session_)
    return std::unexpected{EnvelopeFault::other_session};
  constexpr std::int64_t last_utime = Time::max().count() / 1000;
  if (envelope->utime > last_utime) return std::unexpected{EnvelopeFault::from_the_future};
  const Time made = std::chrono::microseconds{std::max<std::int64_t>(0, envelope->utime)};
  if (made < wall - longest_age) return std::unexpected{EnvelopeFault::too_old};
  if (made > wall + longest_age) return std::unexpected{EnvelopeFault::from_the_future};
  const auto good = check_sender(*envelope, made, wall);
  if (!good) return std::unexpected{good.error()};
  return std::move(*envelope);
}

/// Checks and stores the counter of the sender. If the table is full, senders whose envelopes have
/// all become too old are forgotten.
std::expected<void, EnvelopeFault> EnvelopeGuard::check_sender(const envelope_t& envelope,
                                                               Time made, Time wall) {
  const auto found = std::ranges::find_if(senders_, [&](const Sender& sender) {
    return sender.instance == envelope.instance && sender.key == envelope.key;
  });
  if (found != senders_.end()) {
    if (envelope.counter <= found->counter) return std::unexpected{EnvelopeFault::repeated};
    found->counter = envelope.counter;
    found->newest = std::max(found->newest, made);
    return {};
  }
  if (senders_.size() == most_senders) {
    std::erase_if(senders_,
                  [&](const Sender& sender) { return sender.newest < wall - longest_age; });
  }
  if (senders_.size() == most_senders) return std::unexpected{EnvelopeFault::too_many_senders};
  senders_.push_back({.key = envelope.key,
                      .instance = envelope.instance,
                      .counter = envelope.counter,
                      .newest = made});
  return {};
}

}  // namespace takt
