#pragma once
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

inline constexpr unsigned longest_data = 8;  ///< data bytes of the longest frame

/// A service frame that waits in the queue of the master leaves it within this number of cycles.
inline constexpr int cycles_to_relief = 3;

/// The SDO requests, each with its answer, that the master sends in the slack of a cycle.
struct ServiceShare {
  unsigned dialogues = 1;  ///< number of requests with answers in one round
  Time round{};            ///< one cycle; a long cycle has several rounds
};

/// Returns `service_frames`, limited to the requests whose answers end before the outputs. The
/// master sends no more than these, and none to a node that has not answered yet.
ServiceShare service_share(const BusPlan& plan, double load_of_others) noexcept;

}  // namespace takt
