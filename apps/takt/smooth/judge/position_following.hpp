#pragma once
#include <cstddef>

#include "apps/takt/smooth/judge/axis_cycles.hpp"

namespace takt::smooth {

/// The relation between the actual position (6064) and the set-points.
struct Following {
  std::size_t cycles = 0;  ///< number of cycles in which set-point and 6064 are known
  Time delay{};            ///< following error divided by the velocity
  double fit = 0;          ///< measure of how well the velocity explains the following error, 0..1
  double error_at_peak = 0;  ///< following error at the usual largest velocity, increments
  double ripple = 0;         ///< ripple of the actual velocity around that of the set-points, 0..1
  double ripple_units = 0;   ///< `ripple` in units of 6064 per cycle, or in units of 606C
  double frequency = 0;      ///< frequency of the ripple, Hz; 0 = no ripple
  bool by_velocity = false;  ///< the ripple is that of 606C, otherwise of 6064
};

/// Compares the set-points that are in effect with 6064 of the same cycles. If 6064 does not come
/// once in each cycle, 606C shows the ripple.
Following following_of(const AxisRecord& axis, const AxisCycles& cycles);

}  // namespace takt::smooth
