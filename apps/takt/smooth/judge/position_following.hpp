#pragma once
#include <cstddef>

#include "apps/takt/smooth/judge/axis_cycles.hpp"

namespace takt::smooth {

/// How the actual position (6064) follows the set-points.
struct Following {
  std::size_t cycles = 0;        ///< in which both are known
  Time delay{};                  ///< following error divided by the velocity
  double fit = 0;                ///< how well the velocity explains the following error, 0..1
  double error_at_peak = 0;      ///< following error at the usual largest velocity, increments
  double ripple = 0;             ///< of the actual velocity around that of the set-points, 0..1
  double ripple_increments = 0;  ///< the same in increments a cycle
  double frequency = 0;          ///< of the ripple, Hz; 0 = it has none
};

/// Compares the set-points that are in effect with the positions of the same cycles.
Following following_of(const AxisRecord& axis, const AxisCycles& cycles);

}  // namespace takt::smooth
