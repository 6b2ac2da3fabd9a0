#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "master/motion/position_range.hpp"

namespace takt::motion {

/// The object that a gear follows.
enum class LeaderKind : std::uint8_t {
  commanded,  ///< the commanded position of another axis, in the same cycle
  measured,   ///< a position in the image of the bus
};

/// The way in which the phase of a gear is determined.
enum class PhaseMatch : std::uint8_t {
  here,  ///< the velocities are matched first; the phase is the phase of the axis at that moment
  at,    ///< position = ratio * position of the leader + offset
};

/// The data with which the bus thread runs a gear, besides the limits.
struct GearTask {
  LeaderKind kind = LeaderKind::commanded;
  PhaseMatch match = PhaseMatch::here;
  /// `commanded`: the axis of the leader. `measured`: the axis whose fault means the loss of the
  /// leader.
  std::uint8_t leader_axis = 0xFF;
  std::uint16_t signal = 0;  ///< `measured`: number of the signal in the image
  std::uint8_t bits = 32;    ///< width of this signal
  /// `measured`: number of counts after which the signal wraps; 0 means that it wraps only at its
  /// width. `commanded`: length of a turn of a rotary leader, which begins at `zero`; 0 means that
  /// the leader is not rotary.
  double modulo = 0.0;
  double scale = 1.0;        ///< unit of the leader per count
  double zero = 0.0;         ///< `measured`: position of the leader at the count 0
  double filter_time = 0.0;  ///< `measured`: s, see LeaderEstimate
  double lead = 0.0;         ///< s by which a measured position is older than the set-point
  double ratio = 1.0;        ///< ratio of the velocities
  double offset = 0.0;       ///< offset of the positions; only for PhaseMatch::at
  double turn = 0.0;         ///< PhaseMatch::at: length of a turn of a rotary axis, or 0
  double lock_window = 0.0;  ///< phase error up to which the axis counts as locked
  /// Largest phase error once the axis was locked.
  double max_phase_error = std::numeric_limits<double>::infinity();
  PositionRange range{};  ///< range in which a stop must be possible at any time

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(kind, match, leader_axis, signal, bits, modulo, scale, zero, filter_time, lead, ratio,
          offset, turn, lock_window, max_phase_error, range.min, range.max);
  }
};

/// Returns true if all numbers of the gear are finite where they must be.
inline bool is_sound(const GearTask& task) noexcept {
  const auto finite = [](auto... numbers) { return (std::isfinite(numbers) && ...); };
  return finite(task.modulo, task.scale, task.zero, task.filter_time, task.lead, task.ratio,
                task.offset, task.turn, task.lock_window) &&
         task.modulo >= 0.0 && task.filter_time >= 0.0 && task.lead >= 0.0 &&
         task.lock_window >= 0.0 && task.max_phase_error > 0.0 && task.bits >= 1 && task.bits <= 64;
}

/// The value of a measured leader in the image of a cycle.
struct LeaderSample {
  enum class Age : std::uint8_t {
    fresh,
    missing,  ///< the signal was not received in this cycle
    lost,     ///< the node of the leader does not exchange PDOs
  };
  static constexpr std::uint16_t no_signal = 0xFFFF;

  std::uint16_t signal = no_signal;  ///< see GearTask::signal
  Age age = Age::lost;
  std::int64_t counts = 0;
};

}  // namespace takt::motion
