#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// What became of a send. `error` is an errno (ENOBUFS, ENETDOWN ...) when `sent` is short.
struct SendResult {
  std::size_t sent = 0;
  int error = 0;
};

/// Trouble and news of the interface itself, counted by the port, taken by the loop once a cycle.
struct PortNews {
  bool interface_down = false;         ///< now
  bool error_passive = false;          ///< now
  bool bus_off = false;                ///< now
  std::uint32_t receive_overruns = 0;  ///< frames that the kernel dropped, since the start
  std::uint32_t error_frames = 0;      ///< since the start
  std::uint8_t tx_error_counter = 0;
  std::uint8_t rx_error_counter = 0;
  int last_error = 0;     ///< errno of the newest trouble
  Time since_1970{};      ///< UTC minus the clock of the port; 0 = not known
  Time last_sync_echo{};  ///< when our newest SYNC was on the wire by its echo; 0 = no echo yet

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(interface_down, error_passive, bus_off, receive_overruns, error_frames, tx_error_counter,
          rx_error_counter, last_error, since_1970, last_sync_echo);
  }
};

/// The bus and the clock as the bus loop sees them: SocketCAN, a unix socket or the simulation.
/// One thread. Nothing here allocates, locks or throws.
template <class P>
concept Port = requires(P port, const P constant, Time until, std::span<const Frame> out,
                        std::span<StampedFrame> in) {
  { port.now() } noexcept -> std::same_as<Time>;
  /// Sleeps to an absolute time; may come back late, never early.
  { port.sleep_until(until) } noexcept;
  /// The same for SYNC: wakes early and spins the rest.
  { port.sleep_precisely_until(until) } noexcept;
  /// Sleeps until a frame can be received (true) or the time has come (false).
  { port.wait_frame(until) } noexcept -> std::same_as<bool>;
  /// Takes what has been received, in order, without waiting. Own SYNC echoes are kept back (news).
  { port.receive(in) } noexcept -> std::same_as<std::size_t>;
  /// Hands frames to the bus in order, without waiting.
  { port.send(out) } noexcept -> std::same_as<SendResult>;
  { constant.news() } noexcept -> std::same_as<PortNews>;
};

}  // namespace takt
