#pragma once
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "master/rt/journal/journal.hpp"
#include "master/rt/port.hpp"

namespace takt {

namespace journal {

/// Bits that name the parts of the condition of the port that a record contains. Each part has its
/// own words.
enum ConditionPart : std::uint64_t { echo = 1, utc = 2, state = 4 };
inline constexpr std::size_t state_words = 3;

struct SendPayload {
  std::uint16_t offered = 0;
  std::uint16_t sent = 0;
  std::uint16_t error = 0;

  std::uint64_t packed() const noexcept {
    return std::uint64_t{offered} | std::uint64_t{sent} << 16 | std::uint64_t{error} << 32;
  }
  static SendPayload of(std::uint64_t payload) noexcept {
    return {static_cast<std::uint16_t>(payload), static_cast<std::uint16_t>(payload >> 16),
            static_cast<std::uint16_t>(payload >> 32)};
  }
};

/// Packs all of the condition except its times.
inline void put_state(const PortCondition& condition, std::uint64_t* to) noexcept {
  to[0] = std::uint64_t{condition.interface_down} | std::uint64_t{condition.error_passive} << 1 |
          std::uint64_t{condition.bus_off} << 2 | std::uint64_t{condition.tx_error_counter} << 8 |
          std::uint64_t{condition.rx_error_counter} << 16;
  to[1] = std::uint64_t{condition.receive_overruns} | std::uint64_t{condition.error_frames} << 32;
  to[2] = static_cast<std::uint64_t>(std::int64_t{condition.last_error});
}
inline void get_state(const std::uint64_t* from, PortCondition& condition) noexcept {
  condition.interface_down = (from[0] & 1) != 0;
  condition.error_passive = (from[0] & 2) != 0;
  condition.bus_off = (from[0] & 4) != 0;
  condition.tx_error_counter = static_cast<std::uint8_t>(from[0] >> 8);
  condition.rx_error_counter = static_cast<std::uint8_t>(from[0] >> 16);
  condition.receive_overruns = static_cast<std::uint32_t>(from[1]);
  condition.error_frames = static_cast<std::uint32_t>(from[1] >> 32);
  condition.last_error = static_cast<int>(static_cast<std::int64_t>(from[2]));
}

}  // namespace journal

/// Records the answers of another port. This adds no system call and allocates nothing. Without a
/// journal, the port only forwards. Bus thread only.
template <Port P>
class RecordedPort {
 public:
  /// Keeps pointers to `port` and `journal`.
  RecordedPort(P& port, Journal* journal) noexcept : port_{&port}, journal_{journal} {}

  Time now() noexcept {
    const Time now = port_->now();
    if (journal_ != nullptr) journal_->put(Mark::now, now);
    return now;
  }
  void sleep_until(Time until) noexcept { port_->sleep_until(until); }
  void sleep_precisely_until(Time until) noexcept { port_->sleep_precisely_until(until); }
  bool wait_frame(Time until) noexcept {
    const bool there = port_->wait_frame(until);
    if (journal_ != nullptr) journal_->put(Mark::wait, std::uint64_t{there});
    return there;
  }
  std::size_t receive(std::span<StampedFrame> in) noexcept {
    const std::size_t count = port_->receive(in);
    if (journal_ != nullptr) {
      journal_->put(Mark::receive, count, std::span<const StampedFrame>{in.first(count)});
    }
    return count;
  }
  SendResult send(std::span<const Frame> out) noexcept {
    const SendResult result = port_->send(out);
    if (journal_ != nullptr) {
      const journal::SendPayload payload{.offered = static_cast<std::uint16_t>(out.size()),
                                         .sent = static_cast<std::uint16_t>(result.sent),
                                         .error = static_cast<std::uint16_t>(result.error)};
      journal_->put(Mark::send, payload.packed(), out);
    }
    return result;
  }
  PortCondition condition() const noexcept {
    PortCondition condition = port_->condition();
    if (journal_ != nullptr) note(condition);
    return condition;
  }

 private:
  /// The time of day is accurate to a few microseconds at best. The port hides smaller changes from
  /// the loop, because each would need a record.
  void note(PortCondition& condition) const noexcept {
    constexpr Time jitter = std::chrono::microseconds{50};
    if (beginnings_ != journal_->beginnings()) {
      beginnings_ = journal_->beginnings();
      reported_ = {};
    }
    std::uint64_t parts = 0;
    const Time drift = condition.since_1970 - reported_.since_1970;
    if (drift > jitter || drift < -jitter) {
      parts |= journal::utc;
    } else {
      condition.since_1970 = reported_.since_1970;
    }
    if (condition.last_sync_echo != reported_.last_sync_echo) parts |= journal::echo;
    if (!same_state(condition)) parts |= journal::state;
    const auto bits = static_cast<std::size_t>(std::popcount(parts & 3));
    const std::size_t words = bits + ((parts & journal::state) != 0 ? journal::state_words : 0);
    std::uint64_t* room = journal_->claim(Mark::condition, parts, words);
    if (room != nullptr) {
      if ((parts & journal::echo) != 0) *room++ = count_of(condition.last_sync_echo);
      if ((parts & journal::utc) != 0) *room++ = count_of(condition.since_1970);
      if ((parts & journal::state) != 0) journal::put_state(condition, room);
    }
    if (parts != 0) reported_ = condition;
  }
  /// Returns true if only times have changed since the last record.
  bool same_state(const PortCondition& condition) const noexcept {
    PortCondition recorded = reported_;
    recorded.since_1970 = condition.since_1970;
    recorded.last_sync_echo = condition.last_sync_echo;
    return condition == recorded;
  }
  static std::uint64_t count_of(Time time) noexcept {
    return static_cast<std::uint64_t>(time.count());
  }

  P* port_;
  Journal* journal_;
  mutable PortCondition reported_;  // as recorded last
  mutable unsigned beginnings_ = 0;
};

}  // namespace takt
