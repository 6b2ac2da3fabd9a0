#include "master/rt/port_watch.hpp"

#include <cerrno>

namespace takt {

void PortWatch::on_news(const PortNews& news, Time now) noexcept {
  using enum EventKind;
  if (news.interface_down != seen_.interface_down) {
    const int error = news.interface_down ? news.last_error : 0;
    events_.push({.when = now,
                  .kind = news.interface_down ? interface_down : interface_up,
                  .detail = static_cast<std::uint32_t>(error)});
  }
  if (news.bus_off != seen_.bus_off) {
    events_.push({.when = now, .kind = news.bus_off ? bus_off : bus_recovered});
  }
  if (news.error_passive != seen_.error_passive && !news.bus_off) {
    events_.push({.when = now,
                  .kind = news.error_passive ? bus_error_passive : bus_error_active,
                  .detail = news.rx_error_counter,
                  .value = news.tx_error_counter});
  }
  if (news.receive_overruns != seen_.receive_overruns) {
    const std::uint32_t lost = news.receive_overruns - seen_.receive_overruns;
    events_.push({.when = now, .kind = receive_overrun, .value = lost});
  }
  seen_ = news;
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
