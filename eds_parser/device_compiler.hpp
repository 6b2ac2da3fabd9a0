#pragma once
#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// What a simulated device of this node starts with: the defaults of its EDS (a DCF's values are
/// for the master to write).
DeviceTable compile_device(const NodeSource& node);

}  // namespace takt
