#pragma once
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Something that the master waits for, and how long at most.
struct PlanWait {
  std::string wait;  ///< its name in JSON: "lss_store"
  Time limit{};
  std::string what;
};

/// Every wait that is not told with its node, PDO or boot step.
std::vector<PlanWait> plan_waits(const BusPlan& plan);

}  // namespace takt
