#pragma once
#include <cstdint>
#include <functional>

#include "apps/takt/soak/soak_run.hpp"

namespace takt::soak {

/// Selects which runs are made with each seed.
enum class SoakPart : std::uint8_t {
  bus,    ///< the bus thread and the devices: soak()
  front,  ///< the front thread and programs: soak_front()
  both,
  homing,  ///< programs that home axes: soak_homing()
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
  /// The signal that ended the process in the middle of the run; -1 if it ended without a signal.
  /// 0 means that the run was completed.
  int signal = 0;
};

/// Runs the seeds in separate worker processes, so that a crash can be assigned to its seed. Calls
/// `reported` for each run, in the order in which the runs end.
void run_jobs(const LoadedNetwork& network, const SoakPlan& plan,
              const std::function<void(const SoakReport&)>& reported);

}  // namespace takt::soak
