#pragma once
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <takt/envelope_t.hpp>
#include <takt/lcm.hpp>
#include <utility>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

template <>
consteval std::string_view message_layout<envelope_t>() {
  return "lhlllssn(b)bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb";
}

inline constexpr std::size_t mac_bytes = 32;  ///< length of the MAC at the end of an envelope

/// Puts messages into envelopes, on the side of the sender. All calls come from one thread.
class EnvelopeSeal {
 public:
  /// `instance` is a random number that differs at each start of the sender.
  EnvelopeSeal(EnvelopeKey key, std::int64_t instance);

  /// Returns the encoded envelope, valid until the next call. `wall` is the time of CLOCK_REALTIME.
  Bytes seal(std::string_view channel, Bytes message, std::int64_t session, Time wall);

 private:
  EnvelopeKey key_;
  envelope_t envelope_{};
  std::vector<std::byte> buffer_;
};

/// Reason for refusing an envelope.
enum class EnvelopeFault : std::uint8_t {
  damaged,
  other_schema,
  unknown_key,
  forged,           ///< the MAC does not match: forged, altered, or made with another secret
  other_session,    ///< the envelope is from a replayed log, or the daemon has restarted
  too_old,          ///< the envelope is older than the limit by the clock
  from_the_future,  ///< the envelope is newer than the limit by the clock
  repeated,         ///< this sender has already used this counter or a higher one
  too_many_senders,
};
std::string_view text(EnvelopeFault fault) noexcept;

/// Opens envelopes, on the side of the receiver. An envelope is accepted if a holder of a key made
/// it for this session within the last second, and each envelope is accepted only once and in
/// order. Remembers at most `most_senders` senders. All calls come from one thread.
class EnvelopeGuard {
 public:
  static constexpr Time longest_age = std::chrono::seconds{1};
  static constexpr std::size_t most_senders = 256;
  static constexpr std::size_t most_bytes = 65536;  ///< largest envelope

  /// Without a session, the guard accepts envelopes of any session.
  explicit EnvelopeGuard(std::optional<std::int64_t> session) : session_{session} {}

  void set_keys(std::vector<EnvelopeKey> keys) { keys_ = std::move(keys); }
  /// `wall` is the time of CLOCK_REALTIME.
  std::expected<envelope_t, EnvelopeFault> open(Bytes bytes, Time wall);

 private:
  struct Sender {
    std::string key;
    std::int64_t instance = 0;
    std::int64_t counter = 0;
    Time newest{};  // clock time of the newest envelope of the sender
  };

  std::expected<void, EnvelopeFault> check_sender(const envelope_t& envelope, Time made, Time wall);

  std::optional<std::int64_t> session_;
  std::vector<EnvelopeKey> keys_;
  std::vector<Sender> senders_;
};

}  // namespace takt
