#pragma once
#include <array>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/pdo/pdo_exchange.hpp"
#include "master/core/pdo/pdo_requests.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/rt/machines/service_queue.hpp"
#include "master/rt/machines/services.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {

/// The protocol machines of one bus, and what the parts of the loop count and report. Bus thread
/// only.
template <Services S>
struct BusMachines {
  /// Keeps a reference to the plan.
  BusMachines(const BusPlan& bus_plan, bool only_observe)
      : plan{bus_plan},
        observe{only_observe},
        wire{plan.bitrate},
        pdos{plan, events},
        services{plan, {.observe = observe, .nmt_stop = NmtStop::after_axes}},
        pdo_requests{plan} {}
  BusMachines(const BusMachines&) = delete;
  BusMachines& operator=(const BusMachines&) = delete;

  const BusPlan& plan;
  bool observe;  ///< the master only listens and sends nothing
  WireTime wire;
  EventQueue events;
  PdoExchange pdos;
  S services;
  PdoRequests pdo_requests;
  ServiceQueue service_frames;
  std::array<bool, 128> exchanging{};  ///< by node index: its PDOs are exchanged in this cycle
  bool takes_pdos = false;             ///< the loop takes PDOs of at least one node
  BusStatus status;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(pdos, services, pdo_requests, exchanging, takes_pdos, status.beats);
  }
};

}  // namespace takt
