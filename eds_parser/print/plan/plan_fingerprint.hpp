#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns a hash of everything in the plan that affects the actions of the master. The names of
/// bus and interface and the requested real-time options do not count.
std::string plan_fingerprint(const BusPlan& plan);

}  // namespace takt
