#pragma once
#include <cstdint>
#include <span>

#include "master/motion/beat/motion_message.hpp"
#include "master/rt/journal/journal.hpp"

namespace takt {

/// Records a message about motions. Bus thread.
void put_motion(Journal& journal, motion::MotionMessage& message) noexcept;

/// Reads a message from a record; `words` are the words of the record after its first word. Returns
/// false if they do not form a message. Any content of the words is safe.
bool get_motion(std::span<const std::uint64_t> words, motion::MotionMessage& message) noexcept;

}  // namespace takt
