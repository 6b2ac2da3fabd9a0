#pragma once
// Member functions of BusLoop for the ordered stop, for the stop of axes before NMT ends their PDO
// exchange, and for drives that stop because another node was lost.
#include "master/rt/bus_loop.hpp"

namespace takt {

inline AxesAtRest rest_of(const OrderedStop& stop) noexcept {
  return stop.result() == StopResult::unconfirmed ? AxesAtRest::unconfirmed : AxesAtRest::confirmed;
}

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

/// LossReaction::quick_stop: the drives make a quick stop and stay disabled until the lost node is
/// back.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::stop_drives_after_loss() noexcept {
  if (!network_.stops_drives()) return;
  for (std::size_t i = 0; i < stop_.axes().size(); ++i) {
    const StopAxis& axis = stop_.axes()[i];
    if (!axis.controlword || stops_in_order(i)) continue;
    if (network_.demands_quick_stop(axis.node_index)) {
      pdos_.outputs().force(*axis.controlword, memory_[i].disabled()
                                                   ? OrderedStop::disable_voltage_word
                                                   : OrderedStop::quick_stop_word);
      quick_stopped_[i] = 1;
    } else if (quick_stopped_[i] != 0) {
      pdos_.outputs().release(*axis.controlword);
      quick_stopped_[i] = 0;
    }
  }
}

template <Port P, FrontLink L, Services S>
StopView BusLoop<P, L, S>::stop_view() const noexcept {
  return {.received = {.values = pdos_.image().values,
                       .stale = pdos_.image().stale,
                       .marks = pdos_.inputs().marks()},
          .exchanging = exchanging_,
          .nodes = network_.nodes(),
          .disarmed = options_.observe || stop_requests_.disarmed(),
          .network_stopped = options_.observe || (network_.stopped() && services_.empty())};
}

/// Returns the stop that acts on the axes now. The ordered stop supersedes a halt.
template <Port P, FrontLink L, Services S>
OrderedStop& BusLoop<P, L, S>::active_stop() noexcept {
  return stop_.stage() == StopStage::running ? halt_ : stop_;
}

template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::stops_in_order(std::size_t axis) noexcept {
  const OrderedStop& stop = active_stop();
  return stop.stage() != StopStage::running && stop.reaches(axis);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::begin_stop(Time now) noexcept {
  tell(EventKind::stopping, now);
  if (options_.observe) {
    stop_.begin_idle(now);
  } else {
    stop_.begin(now, network_.nodes(), OrderedStop::every_node, memory_);
    network_.give_up_boots(now);
  }
  halt_.call_off();
  network_.drop_awaiting();
  stop_requests_.begin();
  pdos_.outputs().fall_back();
  call_off_fallbacks();
  pdo_requests_.cancel_all();
}

/// Returns true while a request that may bring a controlword to this axis is unanswered.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::word_under_way(const StopAxis& axis) const noexcept {
  const std::uint8_t node = plan_.nodes[axis.node_index].id.value();
  if (pdo_requests_.reaches(node)) return true;
  const ObjectKey controlword{StopRequests::controlword_of(axis), 0};
  return network_.writes(node, controlword);
}

/// Updates the memory of each axis, on which the next stop may rely.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::remember_axes() noexcept {
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const StopAxis& axis = stop_.axes()[i];
    const WorkingImage& image = pdos_.image();
    std::optional<std::int64_t> statusword;
    const bool heard = axis.statusword && exchanging_[axis.node_index];
    if (heard && memory_[i].news(pdos_.inputs().marks()[axis.word_row].received)) {
      statusword = image.values[*axis.statusword];
    }
    std::optional<std::int64_t> controlword;
    if (axis.controlword && pdos_.outputs().known(*axis.controlword)) {
      controlword = image.values[*axis.controlword];
    }
    if (memory_[i].awaits_answer() && !word_under_way(axis)) memory_[i].note_answer();
    memory_[i].look(statusword, controlword);
    const NodeStatus& node = network_.nodes()[axis.node_index];
    const bool found = node.boot_count == 0 && node.boot != BootState::ready;
    if (found && OrderedStop::says_operational(node)) memory_[i].note_operational();
  }
}

/// Notes a request that may bring a controlword to an axis. The loop does not inspect the content
/// of an RPDO sent on request: it counts as enabling.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::remember_word(const Request& request) noexcept {
  const bool writes = request.kind == RequestKind::sdo_download;
  if (!writes && request.kind != RequestKind::pdo_exchange) return;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const StopAxis& axis = stop_.axes()[i];
    if (plan_.nodes[axis.node_index].id.value() != request.node) continue;
    if (writes && request.object != ObjectKey{StopRequests::controlword_of(axis), 0}) continue;
    const bool known = writes && request.transfer == nullptr && request.size != 0;
    memory_[i].write(known ? std::to_integer<std::int64_t>(request.data[0]) : 0x0F);
  }
}

/// Begins and advances the ordered stop.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::step_stop() noexcept {
  const Time now = port_.now();
  remember_axes();
  follow_own_state();
  if (stop_.stage() == StopStage::running) {
    if (!front_.stop_requested()) return;
    begin_stop(now);
  }
  const StopStage before = stop_.stage();
  const bool decided = stop_.axes_done();
  stop_.step(now, stop_view());
  force_axes(stop_);
  if (stop_.axes_done()) network_.every_axis_at_rest(rest_of(stop_));
  if (!decided && stop_.axes_done()) tell_unconfirmed(stop_, now);
  if (before != StopStage::nmt && stop_.stage() == StopStage::nmt) {
    const bool resets = stop_.result() == StopResult::confirmed &&
                        plan_.stop_disarm == StopDisarm::reset_communication;
    network_.begin_stop(
        now, resets ? NmtCommand::reset_communication : NmtCommand::enter_preoperational);
  }
  done_ = stop_.stage() == StopStage::done;
  if (done_) tell(EventKind::stopped, now);
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::force_axes(const OrderedStop& stop) noexcept {
  for (std::size_t i = 0; i < stop.axes().size(); ++i) {
    const auto signal = stop.axes()[i].controlword;
    const auto word = stop.controlword(i);
    if (signal && word) pdos_.outputs().force(*signal, *word);
  }
}

/// Reports one event for each axis that was not seen at standstill and disabled.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::tell_unconfirmed(const OrderedStop& stop, Time now) noexcept {
  for (std::size_t i = 0; i < stop.axes().size(); ++i) {
    const StopAxis& axis = stop.axes()[i];
    const AxisStop& one = stop.axis(i);
    const AxisVerdict verdict = one.verdict(now, exchanging_[axis.node_index]);
    if (verdict == AxisVerdict::stopped) continue;
    events_.push({.when = now,
                  .kind = EventKind::axis_not_stopped,
                  .node = plan_.nodes[axis.node_index].id.value(),
                  .detail = static_cast<std::uint32_t>(verdict) | std::uint32_t{axis.number} << 8U |
                            (one.by_position() ? 1U << 16U : 0U),
                  .value = event_value(one, verdict, now)});
  }
}

/// Submits the SDO requests of the stop. A master in NMT Stopped disarms nothing, because it is
/// still present.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::ask_for_stop() noexcept {
  const OrderedStop& stop = active_stop();
  const bool halted = &stop == &halt_ && halt_.axes_done();
  if (options_.observe || halted || stop.stage() == StopStage::running) return;
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    stop_requests_.note_boot(i, network_.boot_refused(i));
  }
  const Time now = port_.now();
  while (const Request* request = stop_requests_.next(now, stop, exchanging_, network_.nodes())) {
    if (!network_.submit(*request, now)) return;
    remember_word(*request);
    stop_requests_.submitted();
  }
}

/// Returns the node whose axes must stop before its PDO exchange ends, or every_node.
template <Port P, FrontLink L, Services S>
std::optional<std::uint8_t> BusLoop<P, L, S>::halt_target() const noexcept {
  if (network_.own_state() == NmtState::stopped) return OrderedStop::every_node;
  const auto node = network_.awaits_axes();
  if (!node) return std::nullopt;
  return *node == 0 ? OrderedStop::every_node : static_cast<std::uint8_t>(plan_.index_of(*node));
}

/// A node that NMT stops or sends to PRE-OPERATIONAL no longer exchanges PDOs, and a master in NMT
/// Stopped makes no SYNC (CiA 301, 7.3.2.2). The loop therefore stops the axes first.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::follow_own_state() noexcept {
  const auto target = halt_target();
  if (options_.observe || stop_.stage() != StopStage::running || !target || halt_is_over()) return;
  const Time now = port_.now();
  if (halt_.stage() == StopStage::running) begin_halt(now, *target);
  step_halt(now);
}

/// Informs the network once the axes are at rest or their time is over.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::step_halt(Time now) noexcept {
  if (!halt_.axes_done()) {
    halt_.step(now, stop_view());
    force_axes(halt_);
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      if (halt_.axis(i).rests()) memory_[i].confirm();
    }
    if (halt_.axes_done()) tell_unconfirmed(halt_, now);
  }
  if (halt_.axes_done() || halt_.nothing_to_stop()) network_.axes_at_rest(rest_of(halt_));
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::begin_halt(Time now, std::uint8_t node_index) noexcept {
  halt_.begin(now, network_.nodes(), node_index, memory_);
  stop_requests_.begin();
  if (node_index != OrderedStop::every_node) return;
  pdos_.outputs().fall_back();
  call_off_fallbacks();
}

/// Returns true when the command that the axes of the halt had to stop for has left.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::halt_is_over() const noexcept {
  return halt_.stage() != StopStage::running && halt_target() != halt_.target();
}

/// Gives the controlwords back to the applications. This is done in the cycle after the command,
/// when the RPDOs of its nodes are shut: none may follow the command.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::end_halt() noexcept {
  if (!halt_is_over()) return;
  const bool all = halt_.target() == OrderedStop::every_node;
  for (std::size_t i = 0; i < halt_.axes().size(); ++i) {
    const auto controlword = halt_.axes()[i].controlword;
    if (controlword && halt_.reaches(i)) pdos_.outputs().release(*controlword);
  }
  halt_.call_off();
  if (all) pdos_.outputs().hear_again();
}

/// Returns true in NMT Stopped, when the master sends no SYNC. An ordered stop needs SYNC again to
/// see the axes.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::silent() const noexcept {
  return stop_.stage() == StopStage::running && halt_.axes_done() &&
         network_.own_state() == NmtState::stopped;
}

}  // namespace takt
