#pragma once
#include <optional>
#include <vector>

#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// Frames that count, besides those of the cycle.
enum class Emcys : std::uint8_t {
  none,
  one_of_each,  ///< every node sends one at the same moment
};

/// The latest end of each frame of a cycle, in the order of `traffic.frames`; none: no bound, or
/// no frame of the cycle. Times count from the moment at which the master queues SYNC; where it
/// follows that of another device, from its arrival (SYNC itself: from being queued).
///
/// Frames of a cycle are bounded within it: nothing of the cycle before is left, TPDOs become
/// ready together, outputs go out at the output deadline. All others come whenever they may.
std::vector<std::optional<Time>> cycle_bounds(const BusTraffic& traffic, const BusPlan& plan,
                                              const BudgetOptions& options, Emcys emcys);

}  // namespace takt
