#pragma once
#include <cstddef>
#include <cstdint>

#include "master/core/network/ordered_stop.hpp"
#include "master/core/network/stop_requests.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/stop/axis_memories.hpp"

namespace takt {

/// The two stops of axes: the ordered stop of the whole bus, and the halt of the axes whose PDO
/// exchange NMT is about to end. This class contains what both stops need: the memory of the axes,
/// the view of the bus, the forced controlwords, the SDO requests, and the report on axes that did
/// not stop. Bus thread only.
template <Services S>
class AxisStops {
 public:
  /// Keeps a reference to `bus`.
  explicit AxisStops(BusMachines<S>& bus)
      : bus_{bus}, memories_{bus}, ordered_{bus.plan}, halt_{bus.plan}, requests_{bus.plan} {}

  AxisMemories<S>& memories() noexcept { return memories_; }
  OrderedStop& ordered() noexcept { return ordered_; }
  const OrderedStop& ordered() const noexcept { return ordered_; }
  OrderedStop& halt() noexcept { return halt_; }
  const OrderedStop& halt() const noexcept { return halt_; }
  /// Returns true if the ordered stop has begun.
  bool stopping() const noexcept { return ordered_.stage() != StopStage::running; }
  bool halting() const noexcept { return halt_.stage() != StopStage::running; }
  /// Returns true if one of the two stops commands this axis.
  bool commands(std::size_t axis) noexcept {
    const OrderedStop& stop = active();
    return stop.stage() != StopStage::running && stop.reaches(axis);
  }

  void begin_requests() noexcept { requests_.begin(); }
  /// Advances `stop`, which is one of the two stops, and forces its controlwords.
  void step(OrderedStop& stop, Time now) noexcept {
    const bool decided = stop.axes_done();
    stop.step(now, view());
    for (std::size_t i = 0; i < stop.axes().size(); ++i) {
      const auto signal = stop.axes()[i].controlword;
      const auto word = stop.controlword(i);
      if (signal && word) bus_.pdos.outputs().force(*signal, *word);
    }
    if (!decided && stop.axes_done()) report_unconfirmed(stop, now);
  }

  /// Returns true if SDO requests may be due, see ask(). A master in NMT Stopped does not switch
  /// off the supervision by the devices, because it is still present.
  bool asks() const noexcept {
    if (bus_.observe || (!stopping() && !halting())) return false;
    return stopping() || !halt_.axes_done();
  }
  /// Submits the SDO requests that are due.
  void ask(Time now) noexcept {
    for (std::size_t i = 0; i < bus_.plan.nodes.size(); ++i) {
      requests_.note_boot(i, bus_.services.boot_refused(i));
    }
    while (const Request* request =
               requests_.next(now, active(), bus_.exchanging, bus_.services.nodes())) {
      if (!bus_.services.submit(*request, now)) return;
      memories_.note(*request);
      requests_.submitted();
    }
  }
  /// Takes the answer to a request of ask().
  void take(const Reply& reply, Time now) noexcept {
    if (const auto word = StopRequests::statusword_of(reply)) {
      memories_[word->axis].see(word->value);
    }
    if (requests_.take(reply, now, active())) return;
    const ObjectKey object = requests_.refused_object();
    bus_.events.push({.when = now,
                      .kind = EventKind::still_armed,
                      .node = requests_.refusing_node(),
                      .detail = std::uint32_t{object.index} << 8U | object.sub,
                      .value = requests_.refusal()});
  }

  /// Returns the report to the services about the axes of `stop`.
  static AxesAtRest rest_of(const OrderedStop& stop) noexcept {
    return stop.result() == StopResult::unconfirmed ? AxesAtRest::unconfirmed
                                                    : AxesAtRest::confirmed;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(memories_);
  }

 private:
  /// Returns the stop that acts on the axes now. The ordered stop supersedes a halt.
  OrderedStop& active() noexcept { return stopping() ? ordered_ : halt_; }
  StopView view() const noexcept {
    const S& services = bus_.services;
    return {.received = {.values = bus_.pdos.image().values,
                         .stale = bus_.pdos.image().stale,
                         .marks = bus_.pdos.inputs().marks()},
            .exchanging = bus_.exchanging,
            .nodes = services.nodes(),
            .disarmed = bus_.observe || requests_.disarmed(),
            .network_stopped = bus_.observe || (services.stopped() && bus_.service_frames.empty())};
  }
  void report_unconfirmed(const OrderedStop& stop, Time now) noexcept;

  BusMachines<S>& bus_;
  AxisMemories<S> memories_;
  OrderedStop ordered_;
  OrderedStop halt_;
  StopRequests requests_;
};

/// Returns the value of EventKind::axis_not_stopped.
inline std::int64_t event_value(const AxisStop& axis, AxisVerdict verdict, Time now) noexcept {
  switch (verdict) {
    case AxisVerdict::stopped:
    case AxisVerdict::moving:
    case AxisVerdict::enabled:
    case AxisVerdict::unproven:
      return axis.velocity();
    case AxisVerdict::silent:
    case AxisVerdict::lost:
      return axis.silence(now).count();
    case AxisVerdict::refused:
      return std::int64_t{axis.refusal()};
  }
  return 0;
}

/// Reports one event for each axis that was not seen at standstill and disabled.
template <Services S>
void AxisStops<S>::report_unconfirmed(const OrderedStop& stop, Time now) noexcept {
  for (std::size_t i = 0; i < stop.axes().size(); ++i) {
    const StopAxis& axis = stop.axes()[i];
    const AxisStop& one = stop.axis(i);
    const AxisVerdict verdict = one.verdict(now, bus_.exchanging[axis.node_index]);
    if (verdict == AxisVerdict::stopped) continue;
    bus_.events.push({.when = now,
                      .kind = EventKind::axis_not_stopped,
                      .node = bus_.plan.nodes[axis.node_index].id.value(),
                      .detail = static_cast<std::uint32_t>(verdict) |
                                std::uint32_t{axis.number} << 8U |
                                (one.by_position() ? 1U << 16U : 0U),
                      .value = event_value(one, verdict, now)});
  }
}

}  // namespace takt
