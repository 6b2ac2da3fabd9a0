#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Result of a send. `error` is an errno (ENOBUFS, ENETDOWN ...) if `sent` is short.
struct SendResult {
  std::size_t sent = 0;
  int error = 0;
};

/// State and counters of the interface itself. The port updates them, and the loop takes them once
/// per cycle.
struct PortCondition {
  bool interface_down = false;  ///< current state
  bool error_passive = false;   ///< current state
  bool bus_off = false;         ///< current state
  /// Frames lost in the kernel or in the controller since the start.
  std::uint32_t receive_overruns = 0;
  std::uint32_t error_frames = 0;  ///< CAN error frames since the start
  std::uint8_t tx_error_counter = 0;
  std::uint8_t rx_error_counter = 0;
  int last_error = 0;  ///< errno of the newest failure
  Time since_1970{};   ///< UTC minus the clock of the port; 0 if unknown
  /// Time of the master's newest SYNC on the wire, by its echo; 0 before the first echo.
  Time last_sync_echo{};

  bool operator==(const PortCondition&) const = default;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(interface_down, error_passive, bus_off, receive_overruns, error_frames, tx_error_counter,
          rx_error_counter, last_error, since_1970, last_sync_echo);
  }
};

/// The bus and the clock as the bus loop sees them: SocketCAN, a unix socket or the simulation. One
/// thread uses the port. No function allocates, locks or throws.
template <class P>
concept Port = requires(P port, const P constant, Time until, std::span<const Frame> out,
                        std::span<StampedFrame> in) {
  { port.now() } noexcept -> std::same_as<Time>;
  /// Sleeps until an absolute time; may return late, never early.
  { port.sleep_until(until) } noexcept;
  /// Sleeps until the time of SYNC with higher precision: wakes early and waits actively for the
  /// rest.
  { port.sleep_precisely_until(until) } noexcept;
  /// Sleeps until a frame can be received (returns true) or until the given time (returns false).
  { port.wait_frame(until) } noexcept -> std::same_as<bool>;
  /// Takes the received frames in order, without waiting. Echoes of the master's SYNC appear only
  /// in condition().
  { port.receive(in) } noexcept -> std::same_as<std::size_t>;
  /// Hands frames to the bus in order, without waiting.
  { port.send(out) } noexcept -> std::same_as<SendResult>;
  { constant.condition() } noexcept -> std::same_as<PortCondition>;
};

}  // namespace takt
