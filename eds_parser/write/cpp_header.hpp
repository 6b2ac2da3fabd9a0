#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The image layout as a C++ header without dependencies: positions of all signals by node and
/// name, names, units and scales, and the hash that image_t repeats, so that an application can
/// tell that it was built for another network.
std::string to_cpp_header(const BusPlan& plan);

}  // namespace takt
