#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Returns the greatest length of a frame with `bytes` data bytes in bit times, with worst-case bit
/// stuffing and 3 bits of interframe space: 55 + 10 n for 11-bit, 80 + 10 n for 29-bit identifiers.
/// Davis, Burns et al. 2007.
constexpr std::uint32_t worst_frame_bits(unsigned bytes, bool extended = false) noexcept {
  const std::uint32_t stuffable = (extended ? 54U : 34U) + 8U * bytes;
  return stuffable + 13U + (stuffable - 1U) / 4U;
}

/// Returns the length of the same frame without stuff bits, in bit times: 47 + 8 n for 11-bit, 67 +
/// 8 n for 29-bit identifiers.
constexpr std::uint32_t shortest_frame_bits(unsigned bytes, bool extended = false) noexcept {
  return (extended ? 67U : 47U) + 8U * bytes;
}

/// Returns the time of `bits` on a bus of `bitrate` bit/s, rounded up.
constexpr Time wire_time(std::uint64_t bits, std::uint32_t bitrate) noexcept {
  return Time{static_cast<Time::rep>((bits * 1'000'000'000U + bitrate - 1) / bitrate)};
}

}  // namespace takt
