#pragma once
#include <string>

#include "apps/takt/learn/learned_bus.hpp"

namespace takt::learn {

/// Returns an EDS that is made from the recording, for a device whose own EDS is not available. It
/// holds every object that was read or written, with its width on the bus, and every object that
/// was mapped. An object that was only read is read-only. The sign of a number is known for objects
/// of CiA 301 and CiA 402 only.
std::string made_eds(const LearnedNode& node, const std::string& recording,
                     const std::string& file_name);

}  // namespace takt::learn
