#pragma once
#include <string>

#include "master/wire/frame.hpp"

namespace takt {

/// Describes an LSS frame of the master (0x7E5) or of a device (0x7E4). CiA 305.
std::string lss_text(const Frame& frame, bool from_master);

}  // namespace takt
