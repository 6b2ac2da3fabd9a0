#pragma once
#include <cstdint>
#include <takt/diagnosis_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt {

/// Fills the summary of the bus state. Changes "since the last message" count from the last call.
class Diagnosis {
 public:
  explicit Diagnosis(const BusPlan& plan) : plan_{plan} {}
  diagnosis_t fill(const StatusSnapshot& snapshot);

 private:
  const BusPlan& plan_;
  std::uint64_t send_failures_ = 0;
  std::uint32_t receive_overruns_ = 0;
  std::uint64_t digest_ = 0;
};

}  // namespace takt
