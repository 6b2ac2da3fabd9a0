#pragma once
#include "master/core/network/ordered_stop.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/stop/axis_stops.hpp"
#include "master/rt/stop/sync_loss_reaction.hpp"

namespace takt {

/// The ordered stop of the bus: first the axes, then the supervision of the master, then NMT. See
/// OrderedStop for its stages. Bus thread only.
template <Services S>
class StopSequence {
 public:
  /// Keeps references to all arguments.
  StopSequence(BusMachines<S>& bus, AxisStops<S>& stops, SyncLossReaction<S>& sync_loss) noexcept
      : bus_{bus}, stops_{stops}, sync_loss_{sync_loss} {}

  bool done() const noexcept { return stops_.ordered().stage() == StopStage::done; }

  void begin(Time now) noexcept {
    bus_.events.push({.when = now, .kind = EventKind::stopping});
    if (bus_.observe) {
      stops_.ordered().begin_idle(now);
    } else {
      stops_.ordered().begin(now, bus_.services.nodes(), OrderedStop::every_node,
                             stops_.memories().all());
      bus_.services.give_up_boots(now);
    }
    stops_.halt().call_off();
    bus_.services.drop_awaiting();
    stops_.begin_requests();
    bus_.pdos.outputs().fall_back();
    sync_loss_.call_off_fallbacks();
    bus_.pdo_requests.cancel_all();
  }
  /// Advances the stop after begin(). Call this once a cycle.
  void step(Time now) noexcept {
    OrderedStop& stop = stops_.ordered();
    const StopStage before = stop.stage();
    stops_.step(stop, now);
    if (stop.axes_done()) bus_.services.every_axis_at_rest(AxisStops<S>::rest_of(stop));
    if (before != StopStage::nmt && stop.stage() == StopStage::nmt) {
      bus_.services.begin_stop(now, last_command());
    }
    if (done()) bus_.events.push({.when = now, .kind = EventKind::stopped});
  }

 private:
  NmtCommand last_command() const noexcept {
    const bool resets = stops_.ordered().result() == StopResult::confirmed &&
                        bus_.plan.stop_disarm == StopDisarm::reset_communication;
    return resets ? NmtCommand::reset_communication : NmtCommand::enter_preoperational;
  }

  BusMachines<S>& bus_;
  AxisStops<S>& stops_;
  SyncLossReaction<S>& sync_loss_;
};

}  // namespace takt
