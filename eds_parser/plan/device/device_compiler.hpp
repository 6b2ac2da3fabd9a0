#pragma once
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// Returns the object table that a simulated device of this node starts with: the default values of
/// its EDS. The values of a DCF are left for the master to write.
DeviceTable compile_device(const NodeSource& node);

}  // namespace takt
