#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace takt {

/// An error frame of the kernel in words: `error_class` is its identifier without flags, `data` its
/// eight bytes. linux/can/error.h.
std::string error_frame_text(std::uint32_t error_class, std::span<const std::uint8_t> data);

}  // namespace takt
