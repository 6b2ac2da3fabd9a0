#pragma once
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Joins findings that have the same cause. Lines of a network file may belong to several nodes,
/// because they are in `defaults` or in a YAML anchor that is merged into the nodes. A mistake
/// there gives one finding, which names the other nodes. Findings of the same place, severity and
/// rule are joined if they differ only in the name of the node (between backticks) or in "node N".
void join_shared_lines(Findings& findings, std::string_view file,
                       std::span<const std::string> nodes);

}  // namespace takt
