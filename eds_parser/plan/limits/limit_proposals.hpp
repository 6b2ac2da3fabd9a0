#pragma once
#include "eds_parser/plan/limits/limit_table.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Proposes an entry of `limits:` for an axis that has no limit of a kind. The proposal follows
/// from the limits of the drive itself, as the device file, the DCF and `sdo:` state them. If they
/// state none, the proposal is a sentence without numbers.
void propose_limit(LimitLine& line, const NodeSource& node, const BusPlan& plan,
                   const LimitTable& table);

/// Proposes an entry of `limits: {objects: [...]}` for an output that has no limit. The numbers are
/// the LowLimit and the HighLimit of the device file if these are narrower than the data type. The
/// data type does not show whether an output is a number or a bit field, such as the control word
/// of a drive with a manufacturer-specific profile. The proposal therefore states that it applies
/// to a number.
void propose_range(LimitLine& line, const Signal& output, const NodeSource& node);

}  // namespace takt
