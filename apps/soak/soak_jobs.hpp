#pragma once
#include <cstdint>
#include <functional>

#include "apps/soak/soak_run.hpp"

namespace takt {

/// Which walks each seed is for.
enum class SoakPart : std::uint8_t {
  bus,    ///< the bus thread and the devices: soak()
  front,  ///< the front thread and programs: soak_front()
  both,
};

struct SoakPlan {
  std::uint64_t first = 1;
  std::uint64_t last = 100;
  unsigned jobs = 1;
  SoakPart part = SoakPart::both;
  SoakOptions run{};
};

/// The end of one run as its process reports it.
struct SoakReport {
  SoakOutcome outcome{};
  int signal = 0;  ///< that ended the process in the middle of the run; 0: none
};

/// Runs all seeds in processes of their own, so that a crash names its seed. `told` hears of each
/// run in the order in which they end.
void run_jobs(const LoadedNetwork& network, const SoakPlan& plan,
              const std::function<void(const SoakReport&)>& told);

}  // namespace takt
