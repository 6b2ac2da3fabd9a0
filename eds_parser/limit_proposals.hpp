#pragma once
#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/limit_table.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Where an axis has no limit of a kind, what `limits:` could say: from what the device file, the
/// DCF and `sdo:` say of the drive's own limits, else in words.
void propose_limit(LimitLine& line, const NodeSource& node, const BusPlan& plan,
                   const LimitTable& table);

}  // namespace takt
