#include "master/rt/port_watch.hpp"

#include <cerrno>

namespace takt {

void PortWatch::on_condition(const PortCondition& condition, Time now) noexcept {
  using enum EventKind;
  if (condition.interface_down != seen_.interface_down) {
    const int error = condition.interface_down ? condition.last_error : 0;
    events_.push({.when = now,
                  .kind = condition.interface_down ? interface_down : interface_up,
                  .detail = static_cast<std::uint32_t>(error)});
  }
  if (condition.bus_off != seen_.bus_off) {
    events_.push({.when = now, .kind = condition.bus_off ? bus_off : bus_recovered});
  }
  if (condition.error_passive != seen_.error_passive && !condition.bus_off) {
    events_.push({.when = now,
                  .kind = condition.error_passive ? bus_error_passive : bus_error_active,
                  .detail = condition.rx_error_counter,
                  .value = condition.tx_error_counter});
  }
  if (condition.receive_overruns != seen_.receive_overruns) {
    const std::uint32_t lost = condition.receive_overruns - seen_.receive_overruns;
    events_.push({.when = now, .kind = receive_overrun, .value = lost});
  }
  seen_ = condition;
}

void PortWatch::on_send(std::size_t unsent, int error, Time now) noexcept {
  // Time between two reports of a lasting failure.
  constexpr Time silence = std::chrono::seconds{1};
  if (unsent == 0 || (error != ENOBUFS && error != EAGAIN)) return;
  if (full_reported_ && now - last_full_ < silence) return;
  const SendFailure cause = seen_.bus_off         ? SendFailure::bus_off
                            : seen_.error_passive ? SendFailure::nobody_acknowledges
                                                  : SendFailure::queue_too_short;
  events_.push({.when = now,
                .kind = EventKind::send_buffer_full,
                .detail = static_cast<std::uint32_t>(cause),
                .value = static_cast<std::int64_t>(unsent)});
  full_reported_ = true;
  last_full_ = now;
}

}  // namespace takt
