#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns the image layout as a C++ header without dependencies: positions of all signals by node
/// and name, names, units, scales, and the layout hash. image_t repeats this hash, so that an
/// application can detect that it was built for another network.
std::string to_cpp_header(const BusPlan& plan);

}  // namespace takt
