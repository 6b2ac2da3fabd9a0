#pragma once
#include <string>

#include "apps/learn/learned_bus.hpp"

namespace takt {

/// An EDS of what a recording shows of a device, for those whose own is not at hand: every object
/// that was read or written, with the width it had on the bus, and every one that was mapped. What
/// was only read is read-only; signs of numbers are known for CiA 301 and CiA 402 only.
std::string made_eds(const LearnedNode& node, const std::string& recording,
                     const std::string& file_name);

}  // namespace takt
