#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "master/rt/arrival_prediction.hpp"
#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {

/// Receives the frames of a cycle: sleeps until the predicted arrival of the last expected TPDO,
/// then takes all frames at once. TPDOs go to the image, other frames to the services. Bus thread
/// only.
template <Port P, Services S>
class Intake {
 public:
  /// Keeps references to all arguments.
  Intake(P& port, Beat& beat, BusMachines<S>& bus, TimingHistograms& timing)
      : port_{port},
        beat_{beat},
        bus_{bus},
        timing_{timing},
        prediction_{bus.plan.cycle.sync ? bus.plan.cycle.receive_window : Time{0}},
        received_(batch) {}

  /// Receives until all expected TPDOs have come, or until the end of the receive window.
  void receive() noexcept;
  /// Takes all frames that have come, up to a SYNC that begins the next cycle.
  void drain() noexcept;

  /// Returns the predicted time from SYNC to the arrival of the last expected TPDO.
  Time predicted() const noexcept { return prediction_.predicted(); }
  /// Returns true if no frames are left for the next cycle.
  bool empty() const noexcept { return left_from_ == left_end_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(prediction_);
  }

 private:
  static constexpr std::size_t batch = 256;  ///< most frames that one receive takes
  /// Most wake-ups of one cycle for late PDOs.
  static constexpr unsigned most_wakes = 8;

  void await_rest(Time end) noexcept;
  void learn(bool in_time) noexcept;

  P& port_;
  Beat& beat_;
  BusMachines<S>& bus_;
  TimingHistograms& timing_;
  ArrivalPrediction prediction_;
  std::vector<StampedFrame> received_;
  /// First and end of the frames in `received_` behind a SYNC; they belong to the next cycle.
  std::size_t left_from_ = 0;
  std::size_t left_end_ = 0;
};

template <Port P, Services S>
void Intake<P, S>::receive() noexcept {
  const Time end = beat_.window_end();
  const PdoInputs& inputs = bus_.pdos.inputs();
  // While no node exchanges PDOs (all nodes still boot), the services get the whole slack.
  if (bus_.plan.cycle.sync && bus_.takes_pdos) {
    // If only event-driven PDOs are mapped, there is no arrival to learn; half of the window leaves
    // room for services.
    const bool nothing_due = inputs.expected() == 0 && !prediction_.learned();
    const Time wait = nothing_due ? bus_.plan.cycle.receive_window / 2 : prediction_.predicted();
    port_.sleep_until(std::min(beat_.sync_at() + wait, end));
  }
  drain();
  const bool in_time = inputs.complete();
  if (!in_time) await_rest(end);
  learn(in_time);
}

/// Takes PDOs that are later than predicted as they arrive. Other frames wake this thread as well,
/// so after a few wake-ups the loop takes the rest at the end of the window.
template <Port P, Services S>
void Intake<P, S>::await_rest(Time end) noexcept {
  for (unsigned wakes = 0; wakes < most_wakes; ++wakes) {
    const bool some = port_.wait_frame(end);
    drain();
    if (!some || bus_.pdos.inputs().complete() || beat_.next_sync_came()) return;
  }
  port_.sleep_until(end);
  drain();
}

template <Port P, Services S>
void Intake<P, S>::drain() noexcept {
  BusMachines<S>& bus = bus_;  // avoids a load for each frame
  PdoInputs& inputs = bus.pdos.inputs();
  for (bool more = !beat_.next_sync_came(); more;) {
    const bool left = left_from_ != left_end_;
    const std::size_t first = std::exchange(left_from_, left_end_);
    const std::size_t end = left ? left_end_ : port_.receive(received_);
    for (std::size_t i = left ? first : 0; i < end; ++i) {
      const StampedFrame& stamped = received_[i];
      bus.status.wire_bits += static_cast<std::uint64_t>(WireTime::mean_bits(stamped.frame));
      if (!inputs.receive(stamped)) {
        if (beat_.begins_cycle(stamped)) [[unlikely]] {
          left_from_ = i + 1;
          left_end_ = end;
          return;
        }
        bus.services.on_frame(stamped.frame, stamped.when, bus.service_frames.inbox());
      } else if (bus.pdo_requests.waiting()) [[unlikely]] {
        bus.pdo_requests.on_frame(inputs.row_of(stamped.frame), stamped);
      }
    }
    if (!left) bus.status.frames_received += end;
    more = left || end == received_.size();
  }
}

template <Port P, Services S>
void Intake<P, S>::learn(bool in_time) noexcept {
  const PdoInputs& inputs = bus_.pdos.inputs();
  if (inputs.expected() == 0) return;
  const Time arrival = inputs.last_arrival() - beat_.sync_at();
  if (in_time) {
    prediction_.in_time(arrival);
  } else if (inputs.complete()) {
    prediction_.late(arrival);
  }
  timing_.sync_to_last_pdo.record(arrival);
}

}  // namespace takt
