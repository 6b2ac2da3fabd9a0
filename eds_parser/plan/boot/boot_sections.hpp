#pragma once
#include <chrono>
#include <cstdint>
#include <string>

#include "eds_parser/plan/boot/boot_compiler.hpp"
#include "eds_parser/plan/boot/boot_steps.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The data that all parts of a boot plan share: the node, its dictionary, and the list to which
/// they append their steps.
struct BootPart {
  const NodeSource& node;
  const NodeSpec& spec;
  const ObjectDictionary& dictionary;
  const BootContext& context;
  BootSteps& steps;
  NetworkReport& report;

  /// Reports that `key` of the network file needs an object that can't be written.
  void missing(SourcePos pos, const std::string& key, ObjectKey object) const;
  /// Returns false and warns if the limits of the device exclude `value`. A value that takt derives
  /// from the plan is not written to such a device.
  bool takes(ObjectKey key, std::int64_t value, SourcePos pos,
             const std::string& consequence) const;
};

/// Longest time between two answers of a device during a download in segments.
inline constexpr Time segment_time = std::chrono::seconds{5};

// The sections of the boot of a node, in the order in which they are appended.

/// Appends the steps for SYNC if the device consumes or produces it: 0x1005, 0x1019, 0x1006,
/// 0x1007.
void append_sync(const BootPart& part);

/// Appends the steps for TIME: 0x1012.
void append_time(const BootPart& part);

/// Appends the steps for heartbeat and guarding in both directions, and for the behaviour of the
/// device after an error: 0x1017, 0x1016, 0x100C, 0x100D, 0x1029.
void append_error_control(const BootPart& part);

/// Appends the steps for the identifier and the inhibit time of EMCY: 0x1014, 0x1015.
void append_emergency(const BootPart& part);

/// Appends the steps for one PDO. They compare the PDO with its settings in the device. If anything
/// differs, they configure the PDO in the order that devices accept (CiA 301, 7.5.2.36) and read it
/// back. A fixed mapping is only checked.
void append_pdo(const BootPart& part, const EffectivePdo& pdo);

/// Appends steps that check the version of the device's software and download another version if it
/// differs: 0x1F56 is compared with 0x1F55, then 0x1F51, 0x1F50 and 0x1F57 are used. CiA 302-2 and
/// 302-3.
void append_program(const BootPart& part);

/// Appends steps that write `homing:` of the network file for each axis: 0x6098, 0x6099, 0x609A and
/// 0x607C. Warns if the device file does not list the method (0x60E3) or the mode (0x6502).
void append_homing(const BootPart& part);

/// Appends steps that write values: the ParameterValues of a DCF, the interpolation period of
/// drives, the values of the device data, then the list `sdo:` in its order. Each value is checked
/// against the type, access and limits of the EDS.
void append_values(const BootPart& part);

/// Warns of every number that the boot writes and that lies outside the limits of the device file.
/// BootStep::purpose then mentions the limits as well. A value that is the default in the file
/// causes no warning.
void judge_limits(const NodePdos& node, BootPlan& plan, NetworkReport& report);

}  // namespace takt
