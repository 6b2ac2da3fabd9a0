#pragma once
#include "master/core/network/ordered_stop.hpp"
#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/machines/bus_machines.hpp"

namespace takt {

/// Gives the events of each cycle to the front thread, and from time to time the status of the bus
/// and of the nodes. Bus thread only.
template <FrontLink L, Services S>
class CycleReport {
 public:
  /// Keeps references to all arguments.
  CycleReport(L& front, const Beat& beat, BusMachines<S>& bus) noexcept
      : front_{front}, beat_{beat}, bus_{bus} {}

  void give_events() noexcept {
    Event event;
    while (bus_.services.take(event)) give(event);
    while (bus_.events.pop(event)) give(event);
  }
  /// Gives the last events of the cycle. `stop` is the ordered stop.
  void end_cycle(const OrderedStop& stop) noexcept {
    give_events();
    write_status(stop);
  }

 private:
  static constexpr Time interval = std::chrono::milliseconds{10};

  void write_status(const OrderedStop& stop) noexcept {
    const bool done = stop.stage() == StopStage::done;
    if (beat_.sync_at() - written_ < interval && !done) return;
    BusMachines<S>& bus = bus_;
    BusStatus& status = bus.status;
    written_ = status.when = beat_.sync_at();
    status.cycle = beat_.cycle();
    status.stop = stop.stage();
    status.stop_result = stop.result();
    status.events_lost = bus.events.lost() + bus.services.events_lost();
    status.sync = beat_.sync_state();
    status.sync_period = beat_.sync_period();
    Exchange& exchange = front_.exchange();
    exchange.status.write(
        status, bus.services.nodes(),
        [&](std::size_t row) { return bus.pdos.inputs().status(row); },
        [&](std::size_t row) {
          RpdoStatus rpdo = bus.pdos.outputs().status(row);
          rpdo.sent += bus.pdo_requests.sent(row);
          return rpdo;
        });
    if (done) exchange.finished.store(true, std::memory_order_release);
  }
  void give(Event& event) noexcept {
    event.cycle = beat_.cycle();
    front_.announce(event);
  }

  L& front_;
  const Beat& beat_;
  BusMachines<S>& bus_;
  Time written_{};  ///< SYNC of the cycle in which the status was written
};

}  // namespace takt
