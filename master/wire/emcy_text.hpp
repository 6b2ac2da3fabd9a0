#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace takt {

/// An EMCY error code (also 0x603F of drives) in words: the most specific entry of CiA 301 and
/// CiA 402 that covers it. Never empty.
std::string_view emcy_text(std::uint16_t code) noexcept;

/// Names of the bits set in the error register 0x1001: "generic, voltage"; "none" for zero.
std::string error_register_text(std::uint8_t error_register);

}  // namespace takt
