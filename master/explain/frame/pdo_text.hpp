#pragma once
#include <optional>

#include "master/explain/frame/frame_names.hpp"
#include "master/explain/frame/meaning.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes a PDO or an MPDO of the plan with names, values and units. Returns std::nullopt if the
/// frame is no PDO of the plan.
std::optional<FrameMeaning> planned_pdo(const FrameNames& names, const Frame& frame);

/// Describes a PDO by the predefined connection set. The identifier of `frame` is in the range
/// 0x180..0x57F. CiA 301, 7.3.3.
FrameMeaning predefined_pdo(const FrameNames& names, const Frame& frame);

}  // namespace takt
