#pragma once
#include <filesystem>

#include "apps/takt/simulate/program/program_faults.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/faults.hpp"

namespace takt {

/// A schedule of faults for `takt simulate`. Usable only if `findings` holds no error.
struct FaultFile {
  sim::Faults faults;
  ProgramFaults programs;
  Findings findings;
};

/// Reads a fault file like this one:
///
///     faults:
///       - {kind: power_off, node: elbow, at: 2s, for: 500ms}
///       - {kind: override_value, node: 1, object: 1018:01, value: 0x43}
///
/// A node is given by name or number. All errors are listed at once. A fault of a program is an
/// error if `applications` is 0.
FaultFile read_fault_file(const std::filesystem::path& path, const BusPlan& plan,
                          std::size_t applications = 0);

}  // namespace takt
