#pragma once
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// One kind of wait of the master, with its longest time.
struct PlanWait {
  std::string wait;  ///< name of the wait in JSON: "lss_store"
  Time limit{};
  std::string what;  ///< what the master waits for, in words
};

/// Returns all waits that the plan does not show at a node, PDO or boot step.
std::vector<PlanWait> plan_waits(const BusPlan& plan);

}  // namespace takt
