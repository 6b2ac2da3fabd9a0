#pragma once
#include "eds_parser/cob_ids.hpp"
#include "eds_parser/table/boot_plan.hpp"

namespace takt {

/// Warns of every number that the boot writes although the limits of the device file exclude it,
/// and says so in the purpose of its steps. A value that the file itself has as default passes.
void judge_limits(const NodePdos& node, BootPlan& plan, NetworkReport& report);

}  // namespace takt
