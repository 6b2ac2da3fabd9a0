#pragma once
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// One kind of wait of the master, and how long it lasts at most.
struct PlanWait {
  std::string wait;  ///< name of the wait in JSON: "lss_store"
  Time limit{};
  std::string what;  ///< what the master waits for, in words
};

/// Returns every wait that the plan does not show with its node, PDO or boot step.
std::vector<PlanWait> plan_waits(const BusPlan& plan);

}  // namespace takt
