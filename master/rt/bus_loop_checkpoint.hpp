#pragma once
// Member functions of BusLoop for the checkpoints of a recording, from which a replay can begin.
#include "master/rt/bus_loop.hpp"

namespace takt {

/// Returns true if nothing is under way, so that the state in keep() alone decides what follows.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::idle() const noexcept {
  return stop_.stage() == StopStage::running && halt_.stage() == StopStage::running &&
         left_from_ == left_end_ && !reply_waits_ && services_.empty() && events_.empty() &&
         pdo_requests_.idle() && !fallbacks_.waits() && network_.idle();
}

template <Port P, FrontLink L, Services S>
template <class Archive>
void BusLoop<P, L, S>::keep(Archive& state) noexcept {
  state(pdos_, network_, pdo_requests_, time_, port_watch_, clock_, counter_, hold_, gate_);
  state(follower_, prediction_, exchanging_, quick_stopped_, hearing_, gate_open_, followed_);
  state(sync_lost_, wire_free_, asked_, starved_, held_, sync_sent_, last_sync_, sync_time_);
  state(held_because_, late_cycle_, status_.beats, memory_);
}

/// Writes a checkpoint from time to time, in the slack and only if there is time for it.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::keep_state() noexcept {
  constexpr Time word_time = std::chrono::nanoseconds{10};
  if (!front_.checkpoint_due() || !idle()) return;
  const Time end = clock_.deadline() + plan_.cycle.output_deadline - wire_.worst_dialogue();
  if (published_ + static_cast<Time::rep>(state_words_) * word_time > end) return;
  std::uint64_t* const room = front_.checkpoint(state_words_);
  if (room == nullptr) return;
  StateWriter writer{room};
  keep(writer);
}

template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::resume(std::span<const std::uint64_t> checkpoint) noexcept {
  if (checkpoint.size() != state_words_) return false;
  StateReader reader{checkpoint};
  keep(reader);
  finish_cycle();
  return true;
}

}  // namespace takt
