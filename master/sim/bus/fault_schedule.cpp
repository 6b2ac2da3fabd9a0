#include "master/sim/bus/fault_schedule.hpp"

#include <algorithm>

namespace takt::sim {

FaultSchedule::FaultSchedule(const Faults& faults) {
  for (const Fault& fault : faults) add(fault);
}

void FaultSchedule::add(const Fault& fault) {
  const std::size_t index = faults_.size();
  faults_.push_back(fault);
  insert({fault.at, index, true});
  if (fault.until != never) insert({std::max(fault.at, fault.until), index, false});
}

void FaultSchedule::insert(const Edge& edge) {
  const auto from = edges_.begin() + static_cast<std::ptrdiff_t>(next_);
  edges_.insert(std::upper_bound(from, edges_.end(), edge.at,
                                 [](Time at, const Edge& other) { return at < other.at; }),
                edge);
  find_next();
}

}  // namespace takt::sim
