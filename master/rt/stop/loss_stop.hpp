#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "master/core/network/ordered_stop.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/stop/axis_stops.hpp"

namespace takt {

/// Carries out LossReaction::quick_stop. While a node is lost, each drive of its group receives the
/// command quick stop and, as soon as it is disabled, the command disable voltage. Bus thread only.
template <Services S>
class LossStop {
 public:
  /// Keeps references to all arguments.
  LossStop(BusMachines<S>& bus, AxisStops<S>& stops)
      : bus_{bus}, stops_{stops}, forced_(stops.memories().axes().size()) {}

  /// Call this once a cycle, before the outputs are packed.
  void step() noexcept {
    if (!bus_.services.stops_drives()) return;
    for (std::size_t i = 0; i < forced_.size(); ++i) {
      const StopAxis& axis = stops_.memories().axes()[i];
      if (!axis.controlword || stops_.commands(i)) continue;
      if (bus_.services.demands_quick_stop(axis.node_index)) {
        bus_.pdos.outputs().force(*axis.controlword, stops_.memories()[i].disabled()
                                                         ? OrderedStop::disable_voltage_word
                                                         : OrderedStop::quick_stop_word);
        forced_[i] = 1;
      } else if (forced_[i] != 0) {
        bus_.pdos.outputs().release(*axis.controlword);
        forced_[i] = 0;
      }
    }
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(forced_);
  }

 private:
  BusMachines<S>& bus_;
  AxisStops<S>& stops_;
  std::vector<std::uint8_t> forced_;  ///< by axis: 1 while its controlword is forced
};

}  // namespace takt
