#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "master/core/network/ordered_stop.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/stop/axis_stops.hpp"
#include "master/rt/stop/sync_loss_reaction.hpp"

namespace takt {

/// Stops the axes before NMT ends their PDO exchange. A node that NMT stops or sends to
/// PRE-OPERATIONAL no longer exchanges PDOs, and a master in NMT Stopped makes no SYNC (CiA 301,
/// 7.3.2.2). The command waits until the axes are at rest. The halt lasts until the command was
/// sent, and as long as the master is in NMT Stopped. Bus thread only.
template <Services S>
class NmtHalt {
 public:
  /// Keeps references to all arguments.
  NmtHalt(BusMachines<S>& bus, AxisStops<S>& stops, SyncLossReaction<S>& sync_loss) noexcept
      : bus_{bus}, stops_{stops}, sync_loss_{sync_loss} {}

  /// Begins and advances a halt that an NMT command asks for. Call this once a cycle, unless an
  /// ordered stop has begun.
  void step(Time now) noexcept {
    if (bus_.observe) return;
    const auto target = wanted();
    if (!target || is_over()) return;
    if (!stops_.halting()) begin(now, *target);
    advance(now);
  }
  /// Gives the controlwords back to the applications after the command was sent. This is done in
  /// the cycle after the command, when the master no longer sends RPDOs to the nodes of the
  /// command: no RPDO may follow the command.
  void end_if_over() noexcept {
    if (!is_over()) return;
    OrderedStop& halt = stops_.halt();
    PdoOutputs& outputs = bus_.pdos.outputs();
    for (std::size_t i = 0; i < halt.axes().size(); ++i) {
      const auto controlword = halt.axes()[i].controlword;
      if (controlword && halt.reaches(i)) outputs.release(*controlword);
    }
    halt.call_off();
    if (halt.target() == OrderedStop::every_node) outputs.hear_again();
  }
  /// Returns true if the master sends no SYNC, because it is in NMT Stopped. An ordered stop needs
  /// SYNC again to see the axes.
  bool withholds_sync() const noexcept {
    return !stops_.stopping() && stops_.halt().axes_done() &&
           bus_.services.own_state() == NmtState::stopped;
  }

 private:
  /// Returns the index of the node whose axes must stop before its PDO exchange ends, or
  /// every_node.
  std::optional<std::uint8_t> wanted() const noexcept {
    if (bus_.services.own_state() == NmtState::stopped) return OrderedStop::every_node;
    const auto node = bus_.services.awaits_axes();
    if (!node) return std::nullopt;
    return *node == 0 ? OrderedStop::every_node
                      : static_cast<std::uint8_t>(bus_.plan.index_of(*node));
  }
  /// Returns true if the command for which the axes had to stop was sent.
  bool is_over() const noexcept { return stops_.halting() && wanted() != stops_.halt().target(); }
  void begin(Time now, std::uint8_t node_index) noexcept {
    stops_.halt().begin(now, bus_.services.nodes(), node_index, stops_.memories().all());
    stops_.begin_requests();
    if (node_index != OrderedStop::every_node) return;
    bus_.pdos.outputs().fall_back();
    sync_loss_.call_off_fallbacks();
  }
  /// Permits the command once the axes are at rest or their time is over.
  void advance(Time now) noexcept {
    OrderedStop& halt = stops_.halt();
    if (!halt.axes_done()) {
      stops_.step(halt, now);
      for (std::size_t i = 0; i < halt.axes().size(); ++i) {
        if (halt.axis(i).rests()) stops_.memories()[i].confirm();
      }
    }
    if (halt.axes_done() || halt.nothing_to_stop()) {
      bus_.services.axes_at_rest(AxisStops<S>::rest_of(halt));
    }
  }

  BusMachines<S>& bus_;
  AxisStops<S>& stops_;
  SyncLossReaction<S>& sync_loss_;
};

}  // namespace takt
