#pragma once
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/rt/stop/axis_stops.hpp"
#include "master/rt/stop/loss_stop.hpp"
#include "master/rt/stop/nmt_halt.hpp"
#include "master/rt/stop/stop_sequence.hpp"
#include "master/rt/stop/sync_loss_reaction.hpp"

namespace takt {

/// Everything that stops axes, in the order in which a cycle runs it: the reaction to the loss of
/// SYNC, the halt before an NMT command, the ordered stop, and the quick stop after the loss of a
/// node. Bus thread only.
template <Services S>
class StopControl {
 public:
  /// Keeps a reference to `bus`.
  explicit StopControl(BusMachines<S>& bus)
      : bus_{bus},
        stops_{bus},
        sync_loss_{bus, stops_},
        halt_{bus, stops_, sync_loss_},
        sequence_{bus, stops_, sync_loss_},
        loss_stop_{bus, stops_} {}

  AxisStops<S>& stops() noexcept { return stops_; }
  const OrderedStop& ordered() const noexcept { return stops_.ordered(); }
  /// Returns true if the ordered stop is complete.
  bool done() const noexcept { return sequence_.done(); }

  /// Begins or ends the reaction to the loss of another device's SYNC. `lost` means that SYNC is
  /// lost now.
  void follow_sync(bool lost) noexcept { sync_loss_.follow(lost); }
  /// Ends a halt after its NMT command was sent. Call this before the services run.
  void end_halt() noexcept {
    if (stops_.halting()) halt_.end_if_over();
  }
  /// Submits the SDO requests of the stops. Call this before each round of services.
  template <Port P>
  void submit_requests(P& port) noexcept {
    if (sync_loss_.writes_wait()) sync_loss_.write_fallbacks(port.now());
    if (stops_.asks()) stops_.ask(port.now());
  }
  /// Begins requested stops, and advances those that run. Call this after the services have run.
  template <FrontLink L>
  void step(L& front, Time now) noexcept {
    stops_.memories().update();
    if (!stops_.stopping()) {
      halt_.step(now);
      if (front.stop_requested()) sequence_.begin(now);
    }
    if (stops_.stopping()) sequence_.step(now);
  }
  /// Stops the drives in the group of a lost node. Call this before the outputs are packed.
  void stop_after_loss() noexcept { loss_stop_.step(); }

  /// Returns true if the master sends no SYNC, see NmtHalt.
  bool withholds_sync() const noexcept { return stops_.halting() && halt_.withholds_sync(); }
  /// Returns true if the master sends no RPDOs in this cycle. In NMT Stopped, it only sends
  /// fallbacks that an inhibit time has held back.
  bool withholds_outputs() noexcept {
    return sync_loss_.withholds_outputs() || (withholds_sync() && !bus_.pdos.outputs().pending());
  }
  /// Returns true if no stop and no reaction is in progress, except for a lost SYNC.
  bool idle() const noexcept {
    return !stops_.stopping() && !stops_.halting() && !sync_loss_.writes_wait();
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(stops_, sync_loss_, loss_stop_);
  }

 private:
  BusMachines<S>& bus_;
  AxisStops<S> stops_;
  SyncLossReaction<S> sync_loss_;
  NmtHalt<S> halt_;
  StopSequence<S> sequence_;
  LossStop<S> loss_stop_;
};

}  // namespace takt
