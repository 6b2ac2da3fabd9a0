#pragma once
#include <optional>
#include <span>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns how a node gets its node-ID by LSS, or std::nullopt if the network file does not ask for
/// LSS. `others` holds the nodes before this one.
std::optional<LssPlan> compile_lss(const NodeSpec& node, const ObjectDictionary& dictionary,
                                   std::span<const NodePlan> others, NetworkReport& report);

}  // namespace takt
