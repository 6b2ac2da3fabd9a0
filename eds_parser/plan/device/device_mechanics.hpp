#pragma once
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/mechanics.hpp"

namespace takt {

/// Returns the mechanics of a simulated drive with its positions in counts. Requires that the node
/// has `sim: {mechanics: ...}`.
MechanicsTable compile_mechanics(const NodeSource& node);

}  // namespace takt
