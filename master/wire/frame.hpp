#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// One classic CAN frame. Trivially copyable: it crosses threads.
struct Frame {
  CobId id;
  std::uint8_t length = 0;  ///< 0..8
  bool rtr = false;
  std::array<std::uint8_t, 8> data{};

  constexpr std::span<const std::uint8_t> payload() const noexcept { return {data.data(), length}; }
  constexpr bool operator==(const Frame&) const noexcept = default;
};
static_assert(sizeof(Frame) == 16);

/// A frame from its bytes, at most eight.
constexpr Frame make_frame(CobId id, std::initializer_list<std::uint8_t> bytes) noexcept {
  Frame frame{.id = id};
  for (const std::uint8_t byte : bytes) {
    if (frame.length == 8) break;
    frame.data[frame.length++] = byte;
  }
  return frame;
}

/// A frame and when it was on the wire (monotonic; the kernel's stamp where there is one).
struct StampedFrame {
  Frame frame;
  Time when{};
};

}  // namespace takt
