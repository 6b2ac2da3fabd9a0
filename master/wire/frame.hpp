#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// One classic CAN frame. It is trivially copyable because it is passed between threads.
struct Frame {
  CobId id;
  std::uint8_t length = 0;  ///< 0..8
  /// Remote frame.
  bool rtr = false;
  std::array<std::uint8_t, 8> data{};

  /// Returns the data bytes of the frame.
  constexpr std::span<const std::uint8_t> payload() const noexcept { return {data.data(), length}; }
  constexpr bool operator==(const Frame&) const noexcept = default;
};
static_assert(sizeof(Frame) == 16);

/// Makes a data frame from its bytes; bytes after the eighth are dropped.
constexpr Frame make_frame(CobId id, std::initializer_list<std::uint8_t> bytes) noexcept {
  Frame frame{.id = id};
  for (const std::uint8_t byte : bytes) {
    if (frame.length == 8) break;
    frame.data[frame.length++] = byte;
  }
  return frame;
}

/// A frame and the time when it was on the wire, on the monotonic clock. The time is the timestamp
/// of the kernel if there is one.
struct StampedFrame {
  Frame frame;
  Time when{};
};

}  // namespace takt
