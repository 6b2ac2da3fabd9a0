#pragma once
#include <cstddef>
#include <span>

#include "master/core/event_queue.hpp"
#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/rt/port.hpp"
#include "master/rt/port_watch.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {

/// Hands frames to the port, unless this cycle sends nothing, and counts them. Bus thread only.
template <Port P>
class FrameSender {
 public:
  /// Keeps references to all arguments.
  FrameSender(P& port, const Beat& beat, EventQueue& events, BusStatus& status) noexcept
      : port_{port}, beat_{beat}, status_{status}, watch_{events} {}

  /// Hands the frames to the port. Returns the number of frames that the port has taken, counted
  /// from the first one.
  std::size_t send(std::span<const Frame> frames) noexcept {
    if (!beat_.wire_open()) return 0;
    const SendResult result = port_.send(frames);
    BusStatus& status = status_;
    for (const Frame& frame : frames.first(result.sent)) {
      status.wire_bits += static_cast<std::uint64_t>(WireTime::mean_bits(frame));
    }
    status.frames_sent += result.sent;
    if (result.sent != frames.size()) [[unlikely]] {
      status.send_failures += frames.size() - result.sent;
      watch_.on_send(frames.size() - result.sent, result.error, beat_.sync_at());
    }
    return result.sent;
  }
  /// Reports what has changed at the interface.
  void on_condition(const PortCondition& condition, Time now) noexcept {
    watch_.on_condition(condition, now);
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(watch_);
  }

 private:
  P& port_;
  const Beat& beat_;
  BusStatus& status_;
  PortWatch watch_;
};

}  // namespace takt
