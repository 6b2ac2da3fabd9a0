#pragma once
#include <limits>

#include "master/motion/profile.hpp"

namespace takt::motion {

/// Positions that an axis must not leave, both ends included. By default there are none.
struct PositionRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Returns the least and the greatest position of a motion that starts at `from`.
PositionRange positions_of(const Profile& profile, const State& from) noexcept;

/// Returns true if a motion that starts at `from` stays inside `range`, but for rounding.
bool stays_inside(const PositionRange& range, const Profile& profile, const State& from) noexcept;

}  // namespace takt::motion
