#pragma once
// Member functions of BusLoop for the checkpoints of a recording, from which a replay can begin.
#include "master/rt/bus_loop.hpp"

namespace takt {

/// The first word of a checkpoint. It changes whenever the order of the other words changes,
/// because a checkpoint can only be used by the version of takt that has written it.
inline constexpr std::uint64_t checkpoint_layout = 0x7461'6B74'0000'0008;

/// Returns true if no operation is in progress, so that the state in keep() alone decides what
/// follows.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::idle() const noexcept {
  return stop_.idle() && intake_.empty() && requests_.idle() && bus_.service_frames.empty() &&
         bus_.events.empty() && bus_.pdo_requests.idle() && bus_.services.idle();
}

template <Port P, FrontLink L, Services S>
template <class Archive>
void BusLoop<P, L, S>::keep(Archive& state) noexcept {
  std::uint64_t layout = checkpoint_layout;
  state(layout, bus_, beat_, sender_, intake_, stop_, slack_, motions_);
}

/// Writes a checkpoint from time to time, in the slack and only if there is time for it.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::keep_state() noexcept {
  constexpr Time word_time = std::chrono::nanoseconds{10};
  if (!front_.checkpoint_due() || !idle()) return;
  const Time end = beat_.outputs_due() - bus_.wire.worst_dialogue();
  const std::size_t words = state_words_ + motions_.point_words();
  if (published_ + static_cast<Time::rep>(words) * word_time > end) return;
  std::uint64_t* const room = front_.checkpoint(words);
  if (room == nullptr) return;
  StateWriter writer{room};
  keep(writer);
}

template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::resume(std::span<const std::uint64_t> checkpoint) noexcept {
  if (checkpoint.size() < state_words_ || checkpoint.front() != checkpoint_layout) return false;
  StateReader reader{checkpoint};
  keep(reader);
  if (checkpoint.size() != state_words_ + motions_.point_words()) return false;
  finish_cycle();
  return true;
}

}  // namespace takt
