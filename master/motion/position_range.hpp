#pragma once
#include <limits>

#include "master/motion/profile.hpp"

namespace takt::motion {

/// The range of positions that an axis must not leave. Both ends belong to it. By default it has no
/// ends.
struct PositionRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Returns the range, extended to `position`: an axis outside its range may come back.
PositionRange widened(const PositionRange& range, double position) noexcept;

/// Returns the least and the greatest position of a motion that starts at `from`.
PositionRange positions_of(const Profile& profile, const State& from) noexcept;

/// Returns true if a motion that starts at `from` stays inside `range`. An excess that rounding
/// explains is permitted.
bool stays_inside(const PositionRange& range, const Profile& profile, const State& from) noexcept;

}  // namespace takt::motion
