#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/table/boot_plan.hpp"

namespace takt {

/// Warns of every number that the boot writes and that lies outside the limits of the device file.
/// The purpose of the step then mentions the limits as well. A value that the file itself has as
/// default passes.
void judge_limits(const NodePdos& node, BootPlan& plan, NetworkReport& report);

}  // namespace takt
