#pragma once
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// SDO requests that the master sends in the slack of a cycle, each with its answer.
struct ServiceShare {
  unsigned dialogues = 1;  ///< in one round
  Time round{};            ///< a cycle; long ones have several rounds
};

/// `service_frames`, as far as their answers end before the outputs: the master hands over no
/// more, and none to a node that has not answered yet.
ServiceShare service_share(const BusPlan& plan, double load_of_others) noexcept;

}  // namespace takt
