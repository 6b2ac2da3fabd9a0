#pragma once
#include <string>
#include <vector>

#include "eds_parser/network_file/yaml_tree.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// What the plan of a bus.yml does of which no key of it says a word, and other readers do not:
/// a line each, with the key that says otherwise.
std::vector<std::string> unasked(const YamlNode& root, const BusPlan& plan);

}  // namespace takt
