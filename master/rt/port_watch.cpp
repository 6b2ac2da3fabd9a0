#include "master/rt/port_watch.hpp"

#include <cerrno>

namespace takt {

void PortWatch::announce(EventKind kind, Time now, std::int64_t value,
                         std::uint32_t detail) noexcept {
  events_.push({.when = now, .kind = kind, .detail = detail, .value = value});
}

void PortWatch::on_interface(const PortNews& news, Time now) noexcept {
  if (news.interface_down == seen_.interface_down) return;
  if (news.interface_down) {
    announce(EventKind::interface_down, now, 0, static_cast<std::uint32_t>(news.last_error));
  } else {
    announce(EventKind::interface_up, now);
  }
}

void PortWatch::on_news(const PortNews& news, Time now) noexcept {
  on_interface(news, now);
  if (news.bus_off != seen_.bus_off) {
    announce(news.bus_off ? EventKind::bus_off : EventKind::bus_recovered, now);
  }
  if (news.error_passive != seen_.error_passive && !news.bus_off) {
    announce(news.error_passive ? EventKind::bus_error_passive : EventKind::bus_error_active, now,
             news.tx_error_counter, news.rx_error_counter);
  }
  if (news.receive_overruns != seen_.receive_overruns) {
    announce(EventKind::receive_overrun, now, news.receive_overruns - seen_.receive_overruns);
  }
  seen_ = news;
}

void PortWatch::on_send(std::size_t unsent, int error, Time now) noexcept {
  // Time between two reports of a lasting failure.
  constexpr Time silence = std::chrono::seconds{1};
  if (unsent == 0 || (error != ENOBUFS && error != EAGAIN)) return;
  if (full_reported_ && now - last_full_ < silence) return;
  const SendTrouble cause = seen_.bus_off         ? SendTrouble::bus_off
                            : seen_.error_passive ? SendTrouble::nobody_acknowledges
                                                  : SendTrouble::queue_too_short;
  announce(EventKind::send_buffer_full, now, static_cast<std::int64_t>(unsent),
           static_cast<std::uint32_t>(cause));
  full_reported_ = true;
  last_full_ = now;
}

}  // namespace takt
