#pragma once
#include "master/explain/frame/frame_names.hpp"
#include "master/explain/frame/meaning.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes an EMCY of `node` in the words of its device data, of CiA 402 or of CiA 301. The text
/// also states the length of a frame that does not have eight bytes. CiA 301, 7.2.7.
FrameMeaning emergency_meaning(const FrameNames& names, NodeId node, const Frame& frame);

}  // namespace takt
