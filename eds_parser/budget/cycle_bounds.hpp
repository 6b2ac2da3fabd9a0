#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// Frames that count, besides those of the cycle.
enum class Emcys : std::uint8_t {
  none,
  one_of_each,  ///< every node sends one at the same moment
};

/// Whether the service frames of the master delay what it sends behind them.
enum class Services : std::uint8_t {
  apart,     ///< in a queue of their own, as far as they have not begun
  in_queue,  ///< one queue for all that it sends, as SocketCAN has it
};

/// What is on the bus besides the cycle.
struct Company {
  Emcys emcys = Emcys::none;
  Services services = Services::apart;
};

struct CycleBounds {
  std::vector<std::optional<Time>> ends;  ///< in the order of `traffic.frames`
  Time outputs_wait{};                    ///< in_queue: behind service frames
};

/// The latest end of each frame of a cycle; none: no bound, or no frame of the cycle. Times count
/// from the moment at which the master queues SYNC; where it follows that of another device, from
/// its arrival (SYNC itself: from being queued).
///
/// Frames of a cycle are bounded within it: nothing of the cycle before is left, TPDOs become
/// ready together, outputs go out at the output deadline. All others come whenever they may.
CycleBounds cycle_bounds(const BusTraffic& traffic, const BusPlan& plan,
                         const BudgetOptions& options, Company company);

}  // namespace takt
