#pragma once
#include <cstdint>
#include <vector>

#include "apps/takt/smooth/judge/bus_record.hpp"
#include "apps/takt/smooth/judge/sync_grid.hpp"

namespace takt::smooth {

/// The set-points of an axis between two SYNCs.
struct Cycle {
  Time begin{};
  Time end{};               ///< SYNC at which the set-point takes effect
  bool whole = true;        ///< false: a SYNC is missing between begin and end
  std::uint32_t count = 0;  ///< number of set-points in this cycle
  Time first_arrival{};     ///< arrival of the first set-point; valid only if count is not 0
  Time arrival{};           ///< arrival of the last set-point; valid only if count is not 0
  std::int64_t value = 0;   ///< the last set-point up to `end`
  bool varied = false;      ///< the set-points of the cycle differ from each other
  /// The drive is enabled and in a cyclic mode, as far as the recording shows this.
  bool active = false;
  bool moving = false;  ///< active, and set-points change within a few cycles
};

/// An axis cycle by cycle. Without SYNC, each set-point is a cycle.
struct AxisCycles {
  Time period{};         ///< nominal time between two set-points
  unsigned stride = 1;   ///< a set-point comes with every n-th SYNC
  bool by_sync = false;  ///< false: there is no SYNC
  std::vector<Cycle> cycles;
  /// For each cycle, the number of cycles in sequence up to this one that are in motion with
  /// exactly one set-point.
  std::vector<std::uint32_t> clean_run;
  std::size_t moving = 0;    ///< number of cycles in motion
  std::int64_t quantum = 1;  ///< greatest common divisor of all steps
  double peak = 0;           ///< nine of ten steps in motion are smaller; in increments a cycle

  /// Returns the change of the set-point in cycle `at`, which must not be the first one.
  std::int64_t step(std::size_t at) const noexcept;
  /// Returns true if the cycles [first, last] are in motion without a gap, and each has exactly one
  /// set-point.
  bool clean(std::size_t first, std::size_t last) const noexcept;
  /// Returns the number of cycles from `at` on in which the value stays the same although the axis
  /// was moving, if one large step that compensates for them follows. Returns 0 otherwise.
  std::size_t stall(std::size_t at) const noexcept;
  /// Returns the velocity of a step in increments per second.
  double velocity(double step) const noexcept;
};

/// Returns the difference of two values of 32 bits, also across an overflow.
std::int64_t difference(std::int64_t a, std::int64_t b) noexcept;

AxisCycles axis_cycles(const AxisRecord& axis, const SyncGrid& sync);

}  // namespace takt::smooth
