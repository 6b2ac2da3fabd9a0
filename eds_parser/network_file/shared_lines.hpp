#pragma once
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/source.hpp"

namespace takt {

/// Lines of a network file may belong to several nodes: a YAML anchor that is merged into them, or
/// defaults. A mistake there is one cause and gives one finding, which names the other nodes.
/// Findings of one place, severity and rule are joined where they differ only in the name of the
/// node (between backticks), or in "node N".
void join_shared_lines(Findings& findings, std::string_view file,
                       std::span<const std::string> nodes);

}  // namespace takt
