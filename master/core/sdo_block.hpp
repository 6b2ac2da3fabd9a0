#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/table/waits.hpp"
#include "master/core/event.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// What follows for a block transfer from a frame of the server.
struct SdoBlockStep {
  enum class Kind : std::uint8_t {
    stranger,  ///< of another, earlier transfer: nothing follows
    goes_on,
    done,
    plain,  ///< the server has switched to an ordinary upload
    abort,  ///< it broke the protocol: `abort_code` is to be sent
  };
  Kind kind = Kind::stranger;
  SdoFault fault = SdoFault::aborted_by_master;
  std::uint32_t abort_code = 0;
};

constexpr SdoBlockStep block_abort(std::uint32_t code) noexcept {
  return {.kind = SdoBlockStep::Kind::abort, .abort_code = code};
}

/// Sub-blocks in a row that bring nothing before a transfer is given up: a noisy line gets through,
/// a server that never moves does not hold the channel for good.
inline constexpr std::uint8_t most_fruitless_blocks = 16;

/// Segments of a sub-block that a device may send in one go. Bit/s.
constexpr std::uint8_t sub_block_segments(std::uint32_t bitrate) noexcept {
  constexpr std::int64_t worst_bits = 135;  // of a segment, stuff bits included
  const std::int64_t bits = waits::sub_block * bitrate / std::chrono::seconds{1};
  return static_cast<std::uint8_t>(
      std::clamp<std::int64_t>(bits / worst_bits, 1, most_block_segments));
}

}  // namespace takt
