#pragma once
#include <string>
#include <vector>

#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns the actions in the plan of a bus.yml that no key of the file requests and that other
/// readers do not take. Each action is one line, with the key that changes it.
std::vector<std::string> unasked(const YamlNode& root, const BusPlan& plan);

}  // namespace takt
