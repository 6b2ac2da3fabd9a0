#pragma once
#include <optional>
#include <span>

#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// How a node gets its id by LSS, where the network file wants that. `others`: the nodes before it.
std::optional<LssPlan> compile_lss(const NodeSpec& node, const ObjectDictionary& dictionary,
                                   std::span<const NodePlan> others, NetworkReport& report);

}  // namespace takt
