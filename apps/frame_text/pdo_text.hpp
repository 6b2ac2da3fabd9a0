#pragma once
#include <optional>

#include "apps/frame_text/meaning.hpp"
#include "apps/frame_text/names.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// A PDO or an MPDO of the network's plan: names, values, units. None: no PDO of the plan.
std::optional<FrameMeaning> planned_pdo(const FrameNames& names, const Frame& frame);

/// A PDO by the predefined connection set; `frame` is 0x180..0x57F. CiA 301, 7.3.3.
FrameMeaning predefined_pdo(const FrameNames& names, const Frame& frame);

}  // namespace takt
