#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/table/waits.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// The number of sub-blocks in a row without progress after which a transfer is given up. With this
/// limit, a transfer succeeds on a line with disturbances, but a server that makes no progress does
/// not occupy the channel forever.
inline constexpr std::uint8_t most_stalled_blocks = 16;

/// Returns the number of segments that a device may send in one sub-block, 1..127; `bitrate` is in
/// bit/s.
constexpr std::uint8_t sub_block_segments(std::uint32_t bitrate) noexcept {
  // Bits of a segment in the worst case, including stuff bits.
  constexpr std::int64_t worst_bits = 135;
  const std::int64_t bits = waits::sub_block * bitrate / std::chrono::seconds{1};
  return static_cast<std::uint8_t>(
      std::clamp<std::int64_t>(bits / worst_bits, 1, most_block_segments));
}

}  // namespace takt
