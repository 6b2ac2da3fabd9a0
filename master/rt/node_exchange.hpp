#pragma once
#include <cstddef>
#include <span>

#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/rt/stop/axis_memories.hpp"

namespace takt {

/// Decides which nodes exchange PDOs in this cycle, and how their TPDOs are received. Bus thread
/// only.
template <Port P, FrontLink L, Services S>
class NodeExchange {
 public:
  /// Keeps references to all arguments.
  NodeExchange(P& port, L& front, const Beat& beat, BusMachines<S>& bus,
               AxisMemories<S>& memories) noexcept
      : port_{port}, front_{front}, beat_{beat}, bus_{bus}, memories_{memories} {}

  /// Call this at the begin of each cycle. `axes_stopped` means that an ordered stop has ended for
  /// all axes.
  void update(bool axes_stopped) noexcept {
    // A master that only observes and does not know SYNC cannot wait for the TPDOs that answer
    // SYNC.
    const bool beats = !bus_.observe || beat_.follows();
    // At the end of an ordered stop, a heartbeat sent before the last NMT command may still report
    // OPERATIONAL.
    const Reception beating = axes_stopped ? Reception::early : Reception::full;
    const Reception heard = beats ? beating : Reception::listening;
    bool takes_pdos = false;
    BusMachines<S>& bus = bus_;
    for (std::size_t i = 0; i < bus.plan.nodes.size(); ++i) {
      const bool exchanging = bus.services.exchanges_pdos(i);
      if (exchanging != bus.exchanging[i]) [[unlikely]]
        change(i, exchanging);
      const bool listen = bus.observe || !bus.plan.nodes[i].boot;
      takes_pdos = takes_pdos || exchanging || listen;
      bus.pdos.inputs().set_reception(i, exchanging ? heard : reception_of_other(i, listen));
    }
    bus.takes_pdos = takes_pdos;
  }

 private:
  /// Returns how to receive the TPDOs of a node that does not exchange PDOs yet.
  Reception reception_of_other(std::size_t node_index, bool listen) const noexcept {
    if (listen) return Reception::listening;
    return bus_.services.starts(node_index) ? Reception::early : Reception::off;
  }
  void change(std::size_t node_index, bool exchanging) noexcept {
    bus_.exchanging[node_index] = exchanging;
    PdoOutputs& outputs = bus_.pdos.outputs();
    if (!exchanging) return outputs.shut(node_index);
    outputs.open(node_index, front_.set_points().points);
    const OutputMoment now{beat_.cycle(), port_.now()};
    const std::span<const LimitReading> readings = bus_.services.limits_read(node_index);
    outputs.learn(node_index, readings, now);
    memories_.learn(node_index, readings, now);
  }

  P& port_;
  L& front_;
  const Beat& beat_;
  BusMachines<S>& bus_;
  AxisMemories<S>& memories_;
};

}  // namespace takt
