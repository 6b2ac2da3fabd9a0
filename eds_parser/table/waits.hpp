#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "eds_parser/values/time.hpp"

/// How long the master waits if neither the network file nor a request sets a time. All these times
/// are in one place: the plan prints them and the master uses them.
namespace takt::waits {

using namespace std::chrono_literals;

// SDO
inline constexpr std::uint8_t upload_attempts = 3;  ///< for a boot step; a download is sent once
inline constexpr Time probe_try = 500ms;
inline constexpr Time probe_pause = 50ms;
inline constexpr Time poll_pause = 100ms;  ///< CiA 302-3, flash status
inline constexpr Time sdo_settle = 20ms;
inline constexpr Time own_server = 1s;
/// The segments of a block upload have priority over most frames of the master. `sub_block` is the
/// longest duration of a sub-block on a free bus. Service frames wait for its end, for at most
/// `sub_block_end` for each upload in progress.
inline constexpr Time sub_block = 20ms;
inline constexpr Time sub_block_end = 2 * sub_block;
/// In a block upload the client asks for missing segments before the server's own time-out expires.
constexpr Time block_silence(Time sdo_timeout) noexcept { return sdo_timeout * 7 / 10; }

// PDOs on request
inline constexpr Time pdo_answer = 500ms;
inline constexpr std::size_t pdo_requests = 16;  ///< greatest number of simultaneous requests
/// Returns the longest wait of a request for its turn: all others may wait for the same PDO, one
/// after another.
constexpr Time pdo_turn(Time timeout) noexcept {
  return static_cast<Time::rep>(pdo_requests) * timeout;
}

// LSS
inline constexpr Time lss_answer = 1s;
inline constexpr Time lss_store = 5s;  ///< flash
/// Wait for the answers of all devices; always waited in full.
inline constexpr Time lss_all = 100ms;
inline constexpr Time lss_shortest = 10ms;  ///< wait for the answers of all devices in a scan
inline constexpr Time lss_look_again = 1s;
inline constexpr Time lss_let_boot = 5s;

// SYNC
inline constexpr Time first_sync = 1s;  ///< wait for the SYNC of another device
inline constexpr Time held_sync_first = 100ms;
inline constexpr Time held_sync_longest = 30s;

// applications
inline constexpr Time transfer_silence = 10s;

/// The latest end of each stage of the ordered stop, counted from the beginning of the stop. The
/// quick stop gets most of the time, because a drive that still moves should not be disabled.
struct StopLimits {
  Time fallback{};
  Time quick_stop{};
  Time disable{};
  Time disarm{};
  Time nmt{};
};
constexpr StopLimits stop_limits(Time timeout, Time period) noexcept {
  return {.fallback = timeout / 10,
          .quick_stop = timeout * 8 / 10,
          .disable = timeout * 87 / 100,
          .disarm = timeout * 94 / 100,
          .nmt = timeout - std::min(timeout / 20, 2 * period)};
}
inline constexpr Time stop_default = 5s;
inline constexpr Time stop_longest = 30s;  ///< upper limit if the time follows from the drives
/// Returns the time-out of a whole ordered stop in which the quick stop takes `stopping`. It
/// includes a margin of a quarter for what the ramp does not cover: jerk, following error,
/// detection.
constexpr Time stop_timeout_for(Time stopping) noexcept {
  return std::min(stop_longest, std::max(stop_default, stopping * 5 / 4 * 10 / 8));
}

}  // namespace takt::waits
