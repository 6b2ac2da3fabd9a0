#pragma once
#include <cstdint>
#include <string_view>

namespace takt::mcap {

/// CRC-32 of IEEE 802.3, as zlib computes it: polynomial 0x04C11DB7, reflected.
class Crc32 {
 public:
  void add(std::string_view bytes) noexcept;
  /// Returns the CRC of all bytes so far.
  std::uint32_t value() const noexcept { return ~state_; }

 private:
  std::uint32_t state_ = 0xFFFFFFFF;
};

/// Returns the CRC of these bytes.
std::uint32_t crc32(std::string_view bytes) noexcept;

}  // namespace takt::mcap
