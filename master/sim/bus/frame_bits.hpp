#pragma once
#include <cstdint>

#include "master/wire/frame.hpp"

namespace takt::sim {

/// Bits of the interframe space, which follows every frame. ISO 11898-1.
inline constexpr std::uint32_t interframe_bits = 3;

/// Bit counts and checksum of a frame on the wire.
struct FrameBits {
  std::uint16_t total = 0;  ///< bits from SOF to EOF, without interframe space
  std::uint16_t stuff = 0;  ///< stuff bits
  std::uint16_t crc = 0;    ///< CRC-15
};

/// Computes the exact length of a classic CAN frame, including CRC, stuff bits, ACK and EOF.
FrameBits frame_bits(const Frame& frame) noexcept;

}  // namespace takt::sim
