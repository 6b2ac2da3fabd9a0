#pragma once
#include <cstddef>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/sim/bus/faults.hpp"

namespace takt::sim {

/// The starts and ends of faults in the order of time.
class FaultSchedule {
 public:
  struct Edge {
    Time at{};
    std::size_t fault = 0;
    bool begins = true;
  };

  explicit FaultSchedule(const Faults& faults);
  void add(const Fault& fault);

  Time next() const noexcept { return next_at_; }
  Edge take() noexcept {
    const Edge edge = edges_[next_++];
    find_next();
    return edge;
  }
  const Fault& fault(std::size_t index) const noexcept { return faults_[index]; }

 private:
  void insert(const Edge& edge);
  void find_next() noexcept { next_at_ = next_ < edges_.size() ? edges_[next_].at : never; }

  Faults faults_;
  std::vector<Edge> edges_;  ///< sorted by time, then by order of addition
  std::size_t next_ = 0;
  Time next_at_ = never;  ///< time of edges_[next_], which the world reads in each step
};

}  // namespace takt::sim
