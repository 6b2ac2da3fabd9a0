#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "apps/simulate/program_faults.hpp"
#include "eds_parser/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/faults.hpp"

namespace takt {

/// A schedule of faults for `takt simulate`. Usable only where `findings` holds no error.
struct FaultFile {
  sim::Faults faults;
  ProgramFaults programs;
  Findings findings;
};

/// Reads
///
///     faults:
///       - {kind: power_off, node: elbow, at: 2s, for: 500ms}
///       - {kind: override_value, node: 1, object: 1018:01, value: 0x43}
///
/// Nodes go by name or number. All errors are listed at once. What happens to programs is an error
/// where there are no `applications`.
FaultFile read_fault_file(const std::filesystem::path& path, const BusPlan& plan,
                          std::size_t applications = 0);

}  // namespace takt
