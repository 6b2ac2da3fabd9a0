#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "master/explain/frame/frame_names.hpp"
#include "master/explain/frame/meaning.hpp"
#include "master/wire/frame.hpp"

namespace takt {

// The texts of frames and values whose meaning does not depend on earlier frames.

/// Describes an EMCY of `node` in the words of its device data, of CiA 402 or of CiA 301. The text
/// also states the length of a frame that does not have eight bytes. CiA 301, 7.2.7.
FrameMeaning emergency_meaning(const FrameNames& names, NodeId node, const Frame& frame);

/// Describes an LSS frame of the master (0x7E5) or of a device (0x7E4). CiA 305.
std::string lss_text(const Frame& frame, bool from_master);

/// Describes a PDO or an MPDO of the plan with names, values and units. Returns std::nullopt if the
/// frame is no PDO of the plan.
std::optional<FrameMeaning> planned_pdo(const FrameNames& names, const Frame& frame);

/// Describes a PDO by the predefined connection set. The identifier of `frame` is in the range
/// 0x180..0x57F. CiA 301, 7.3.3.
FrameMeaning predefined_pdo(const FrameNames& names, const Frame& frame);

/// Describes the value of an object of the communication profile whose number alone does not show
/// its meaning: identifiers, mapping entries, heartbeat consumers, "save", NMT requests. Empty for
/// all other objects.
std::string object_meaning(const FrameNames& names, unsigned node, ObjectKey key,
                           std::span<const std::uint8_t> bytes);

}  // namespace takt
