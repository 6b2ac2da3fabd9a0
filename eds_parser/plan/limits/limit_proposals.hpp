#pragma once
#include "eds_parser/plan/limits/limit_table.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Proposes an entry of `limits:` for an axis that has no limit of a kind. The proposal follows
/// from the limits of the drive itself, as the device file, the DCF and `sdo:` state them. If they
/// state none, the proposal is in words.
void propose_limit(LimitLine& line, const NodeSource& node, const BusPlan& plan,
                   const LimitTable& table);

}  // namespace takt
