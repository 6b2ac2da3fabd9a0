#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/motion/beat/axis_motions.hpp"
#include "master/motion/beat/motion_message.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/motion/driven_axis.hpp"

namespace takt {

/// Runs the motions of the axes between the image and the outputs of each cycle. Costs nothing
/// until the first message about motions has come. Bus thread only.
template <FrontLink L, Services S>
class MotionStage {
 public:
  /// Keeps references to both arguments.
  MotionStage(L& front, BusMachines<S>& bus)
      : front_{front},
        bus_{bus},
        motions_{motion_axes(bus.plan).size(),
                 std::chrono::duration<double>{bus.plan.cycle.period}.count()} {
    for (const MotionAxis& axis : motion_axes(bus.plan)) axes_.emplace_back(axis, bus.plan);
    inputs_.resize(axes_.size());
  }

  /// Runs one cycle, after its image is complete and before its outputs are packed. `stopping`
  /// states whether the ordered stop has begun.
  void run(OutputMoment moment, bool stopping) noexcept {
    if (bus_.observe) return;
    take_messages(moment.cycle);
    if (!active_) return;
    forget_homes();
    if (bus_.status.beats != beats_) run_beat(moment, stopping);
    const bool late = is_late(moment);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const bool kept = late ? motions_.outlives_gap(static_cast<std::uint8_t>(i), moment.cycle)
                             : motions_.reports()[i].kept_alive;
      if (kept) axes_[i].keep_alive(bus_.pdos.outputs(), moment);
    }
  }

  /// Returns the number of words of keep() that the points of streams need.
  std::size_t point_words() const noexcept {
    return motions_.points() * motion::StreamPoint::kept_words;
  }
  template <class Archive>
  void keep(Archive& state) noexcept {
    state(active_, beats_, last_run_, axes_, motions_);
  }

 private:
  /// Largest number of periods without SYNC in which a motion goes on. After more periods, the
  /// drives no longer follow, and the axis would jump if its motion went on.
  static constexpr motion::CycleNumber most_missed = 1;

  bool is_late(OutputMoment moment) const noexcept {
    return last_run_ != 0 && moment.cycle - last_run_ > most_missed + 1;
  }
  void take_messages(motion::CycleNumber cycle) noexcept {
    for (std::size_t i = 0; i < motions_a_cycle && front_.take_motion(message_); ++i) {
      active_ = true;
      accept(message_, cycle);
    }
  }
  void accept(const motion::MotionMessage& message, motion::CycleNumber cycle) noexcept;
  void run_beat(OutputMoment moment, bool stopping) noexcept;
  /// Forgets the home positions of nodes that do not exchange PDOs. This is done in each cycle,
  /// because a device may be switched off and on while there is no SYNC.
  void forget_homes() noexcept {
    for (DrivenAxis& axis : axes_) {
      if (!bus_.exchanging[axis.node_index()]) axis.lose_home();
    }
  }
  void tell_ends() noexcept;
  motion::LeaderSample sample_of(std::uint16_t signal) const noexcept;

  L& front_;
  BusMachines<S>& bus_;
  std::vector<DrivenAxis> axes_;
  motion::AxisMotions motions_;
  std::vector<motion::AxisInput> inputs_;
  motion::MotionMessage message_;     ///< the message that is being taken
  std::uint64_t beats_ = 0;           ///< BusStatus::beats when a beat was run last
  motion::CycleNumber last_run_ = 0;  ///< the cycle in which a beat was run last
  bool active_ = false;               ///< a message about motions has come
};

template <FrontLink L, Services S>
void MotionStage<L, S>::accept(const motion::MotionMessage& message,
                               motion::CycleNumber cycle) noexcept {
  switch (message.kind) {
    case motion::MessageKind::heard:
      motions_.sender_heard(message.sender, std::min(message.cycle, cycle));
      break;
    case motion::MessageKind::stop:
      motions_.stop_axis(message.axis, motion::StopCause::application);
      break;
    case motion::MessageKind::left:
      motions_.sender_left(message.axis, message.sender);
      break;
    case motion::MessageKind::watch:
      break;
    case motion::MessageKind::renew:
      motions_.renew_jog(message.axis, {message.sender, std::min(message.cycle, cycle)});
      break;
    case motion::MessageKind::release:
      motions_.release_gear(message.axis);
      break;
    case motion::MessageKind::points:
      motions_.add_points(message.axis, message.points);
      break;
    case motion::MessageKind::order: {
      const motion::Outcome refusal = motions_.take(message.order);
      if (refusal == motion::Outcome::none) break;
      const motion::EndedOrder ended{.id = message.order.id, .outcome = refusal};
      front_.exchange().motion_ends.push({.axis = message.order.axis, .order = ended, .stop = {}});
      break;
    }
  }
}

template <FrontLink L, Services S>
void MotionStage<L, S>::run_beat(OutputMoment moment, bool stopping) noexcept {
  beats_ = bus_.status.beats;
  if (is_late(moment)) motions_.abandon_all(motion::StopCause::no_sync);
  last_run_ = moment.cycle;
  if (stopping) motions_.stop_all(motion::StopCause::ordered_stop);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool exchanging = bus_.exchanging[axes_[i].node_index()];
    inputs_[i] = axes_[i].read(bus_.pdos, exchanging, motions_.reports()[i]);
    const motion::LeaderSignals leaders = motions_.leader_signals(i, moment.cycle);
    for (std::size_t k = 0; k < leaders.size(); ++k) {
      if (leaders[k]) inputs_[i].leaders[k] = sample_of(*leaders[k]);
    }
  }
  const auto reports = motions_.run(moment.cycle, inputs_);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].write(bus_.pdos.outputs(), reports[i], moment) || stopping) continue;
    const bool overruled = axes_[i].is_overruled(bus_.pdos.outputs());
    motions_.abandon(static_cast<std::uint8_t>(i),
                     overruled ? motion::StopCause::nmt_command : motion::StopCause::limit);
  }
  tell_ends();
  front_.exchange().motion_board.write(moment.cycle, reports);
}

/// Returns the sample of a signal. The number of the signal comes from the front thread or from a
/// recording, so it is checked.
template <FrontLink L, Services S>
motion::LeaderSample MotionStage<L, S>::sample_of(std::uint16_t signal) const noexcept {
  using Age = motion::LeaderSample::Age;
  if (signal >= bus_.plan.layout.inputs) return {.signal = signal, .age = Age::lost};
  const bool exchanging = bus_.exchanging[bus_.plan.layout.signals[signal].node_index];
  if (!exchanging) return {.signal = signal, .age = Age::lost};
  const WorkingImage& image = bus_.pdos.image();
  return {.signal = signal,
          .age = image.is_stale(signal) ? Age::missing : Age::fresh,
          .counts = image.values[signal]};
}

template <FrontLink L, Services S>
void MotionStage<L, S>::tell_ends() noexcept {
  const auto reports = motions_.reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    for (const motion::EndedOrder& order : reports[i].ended.orders()) {
      front_.exchange().motion_ends.push(
          {.axis = static_cast<std::uint8_t>(i), .order = order, .stop = reports[i].stop});
    }
  }
}

}  // namespace takt
