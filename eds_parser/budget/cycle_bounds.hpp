#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// The EMCYs that the analysis counts.
enum class Emcys : std::uint8_t {
  none,
  one_of_each,  ///< every node sends one EMCY at the same moment
};

/// States whether the service frames of the master delay the frames that it sends after them.
enum class Services : std::uint8_t {
  apart,     ///< no: they wait in a separate queue unless they have already begun
  in_queue,  ///< yes: one queue holds all frames of the master, as in SocketCAN
};

/// The frames that the analysis counts besides those of the cycle.
struct OtherTraffic {
  Emcys emcys = Emcys::none;
  Services services = Services::apart;
};

struct CycleBounds {
  std::vector<std::optional<Time>> ends;  ///< ends in the order of `traffic.frames`
  /// Time for which the outputs wait behind service frames in the queue (`in_queue`).
  Time outputs_wait{};
};

/// Returns the latest end of each frame of a cycle. An end is empty if there is no bound or if the
/// frame does not belong to the cycle. Times count from the moment at which the master queues SYNC.
/// If the master follows the SYNC of another device, they count from the arrival of that SYNC. The
/// end of that SYNC itself then counts from the moment at which its sender queues it.
///
/// The analysis bounds the frames of a cycle within that cycle: no frame of the cycle before is
/// left, all TPDOs become ready together, and the outputs are sent at the output deadline. All
/// other frames may come at any time.
CycleBounds cycle_bounds(const BusTraffic& traffic, const BusPlan& plan,
                         const BudgetOptions& options, OtherTraffic other_traffic);

}  // namespace takt
