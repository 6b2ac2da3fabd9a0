#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "master/explain/frame/frame_names.hpp"

namespace takt {

/// Describes the value of an object of the communication profile whose number alone does not show
/// its meaning: identifiers, mapping entries, heartbeat consumers, "save", NMT requests. Empty for
/// all other objects.
std::string object_meaning(const FrameNames& names, unsigned node, ObjectKey key,
                           std::span<const std::uint8_t> bytes);

}  // namespace takt
