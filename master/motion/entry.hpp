#pragma once
#include "master/motion/transfer.hpp"

namespace takt::motion {

/// Brings a velocity and an acceleration inside their limits: by a phase with jerk, and a phase
/// that holds the acceleration. In the units of Transfer.
struct Entry {
  double jerk = 0.0;      ///< 1, -1, or 0 if the state is inside already
  double duration = 0.0;  ///< of the phase with jerk
  double hold = 0.0;      ///< of the phase with the acceleration that it ends with
};

/// Returns the shortest entry of the start of `transfer`. A state is inside if its velocity and its
/// acceleration are inside their limits, and if its velocity stays there while the acceleration is
/// taken back to 0. If no such state can be reached without leaving the limit on the other side,
/// the entry ends before that limit.
Entry entry(const Transfer& transfer) noexcept;

}  // namespace takt::motion
