#pragma once
#include "eds_parser/plan/boot/boot_steps.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// Appends steps that check the version of the device's software and download another version if it
/// differs: 0x1F56 is compared with 0x1F55, then 0x1F51, 0x1F50 and 0x1F57 are used. CiA 302-2 and
/// 302-3.
void append_program(const NodeSpec& node, BootSteps& steps, NetworkReport& report);

}  // namespace takt
