#pragma once
#include <cstdint>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Computes how long frames occupy the wire.
class WireTime {
 public:
  explicit WireTime(std::uint32_t bitrate) noexcept
      : bit_{1'000'000'000 / (bitrate == 0 ? 1'000'000 : bitrate)} {}

  /// Returns the number of bits of a frame with the most stuff bits, including the interframe
  /// space. CiA 301 does not specify this; ISO 11898-1 stuffs after five equal bits.
  static constexpr std::int64_t worst_bits(const Frame& frame) noexcept {
    const std::int64_t data = data_bits(frame);
    return frame.id.is_extended() ? 67 + data + (54 + data - 1) / 4
                                  : 47 + data + (34 + data - 1) / 4;
  }
  /// Returns the number of bits of a frame with the stuff bits of random data.
  static constexpr std::int64_t mean_bits(const Frame& frame) noexcept {
    const std::int64_t data = data_bits(frame);
    return (frame.id.is_extended() ? 69 : 48) + data + data / 32;
  }
  Time worst(std::span<const Frame> frames) const noexcept {
    std::int64_t bits = 0;
    for (const Frame& frame : frames) bits += worst_bits(frame);
    return bit_ * bits;
  }
  Time mean(std::span<const Frame> frames) const noexcept {
    std::int64_t bits = 0;
    for (const Frame& frame : frames) bits += mean_bits(frame);
    return bit_ * bits;
  }
  std::int64_t bits_in(Time time) const noexcept { return time / bit_; }
  /// Returns the wire time of one request of eight bytes and its answer.
  Time worst_dialogue() const noexcept { return bit_ * (2 * 135); }

 private:
  /// Returns the number of data bits. A remote frame has a length but carries no data.
  static constexpr std::int64_t data_bits(const Frame& frame) noexcept {
    return frame.rtr ? 0 : 8 * std::int64_t{frame.length};
  }

  Time bit_;
};

}  // namespace takt
