#pragma once
#include "apps/frame_text/meaning.hpp"
#include "apps/frame_text/names.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// An EMCY of `node` in the words of its device data, of CiA 402 and of CiA 301. Frames that are
/// shorter than eight bytes are told as what they are. CiA 301, 7.2.7.
FrameMeaning emergency_meaning(const FrameNames& names, NodeId node, const Frame& frame);

}  // namespace takt
