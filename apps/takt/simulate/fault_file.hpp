#pragma once
#include <filesystem>

#include "apps/takt/simulate/motion/motion_script.hpp"
#include "apps/takt/simulate/program/program_faults.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/bus/faults.hpp"

namespace takt {

/// A schedule of faults, and of the motions that programs command, for `takt simulate`. Usable only
/// if `findings` holds no error.
struct FaultFile {
  sim::Faults faults;
  ProgramFaults programs;
  MotionScripts motions;
  Findings findings;
};

/// Reads a fault file like this one:
///
///     faults:
///       - {kind: power_off, node: elbow, at: 2s, for: 500ms}
///       - {kind: override_value, node: 1, object: 1018:01, value: 0x43}
///     motions:
///       - {kind: enable, axes: [elbow]}
///       - {kind: move, at: 2s, to: 1.5, velocity: 3, acceleration: 20}
///
/// A node is given by name or number. All errors are listed at once. `applications` is the number
/// of applications. If it is 0, a fault of an application is an error; a fault that concerns all
/// programs is an error if, in addition, no program commands motions.
FaultFile read_fault_file(const std::filesystem::path& path, const BusPlan& plan,
                          std::size_t applications = 0);

}  // namespace takt
