#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "apps/frame_text/names.hpp"

namespace takt {

/// What the value of an object of the communication profile says, where its number does not:
/// identifiers, mapping entries, heartbeat consumers, "save", NMT requests. Empty: nothing to add.
std::string object_meaning(const FrameNames& names, unsigned node, ObjectKey key,
                           std::span<const std::uint8_t> bytes);

}  // namespace takt
