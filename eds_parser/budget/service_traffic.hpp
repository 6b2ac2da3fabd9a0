#pragma once
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The SDO requests, each with its answer, that the master sends in the slack of a cycle.
struct ServiceShare {
  unsigned dialogues = 1;  ///< requests with answers in one round
  Time round{};            ///< one cycle; a long cycle has several rounds
};

/// Returns `service_frames`, limited to the requests whose answers end before the outputs. The
/// master sends no more than these, and none to a node that has not answered yet.
ServiceShare service_share(const BusPlan& plan, double load_of_others) noexcept;

}  // namespace takt
