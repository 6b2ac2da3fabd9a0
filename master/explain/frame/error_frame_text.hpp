#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace takt {

/// Describes an error frame of the kernel. `error_class` is the identifier without its flags,
/// `data` holds the eight bytes. See linux/can/error.h.
std::string error_frame_text(std::uint32_t error_class, std::span<const std::uint8_t> data);

}  // namespace takt
