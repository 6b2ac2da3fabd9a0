#pragma once
// Member functions of BusLoop for the exchange with the front thread.
#include "master/rt/bus_loop.hpp"

namespace takt {

template <Port P, Services S>
const SetPointFrame& BusLoop<P, S>::newest_set_points() noexcept {
  if constexpr (WitnessPort<P>) {
    return port_.set_points(exchange_);
  } else {
    return exchange_.set_points.newest();
  }
}

template <Port P, Services S>
bool BusLoop<P, S>::next_request() noexcept {
  if constexpr (WitnessPort<P>) {
    return port_.take_request(exchange_, request_);
  } else {
    return exchange_.requests.pop(request_);
  }
}

template <Port P, Services S>
bool BusLoop<P, S>::asked_to_stop() noexcept {
  if constexpr (WitnessPort<P>) {
    return port_.stop_requested(exchange_);
  } else {
    return exchange_.stop_requested.load(std::memory_order_relaxed);
  }
}

template <Port P, Services S>
bool BusLoop<P, S>::give_reply() noexcept {
  if constexpr (WitnessPort<P>) {
    return port_.give_reply(exchange_, reply_);
  } else {
    return !exchange_.replies.full() && exchange_.replies.push(reply_);
  }
}

template <Port P, Services S>
void BusLoop<P, S>::give_event(Event& event) noexcept {
  event.cycle = clock_.cycle();
  if constexpr (WitnessPort<P>) {
    port_.tell(exchange_, event);
  } else {
    exchange_.events.push(event);
  }
}

}  // namespace takt
