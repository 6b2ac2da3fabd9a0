#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace takt {

/// Returns the number whose bytes these are, lowest byte first. Bytes after the eighth do not
/// count.
constexpr std::uint64_t from_little_endian(std::span<const std::byte> bytes) noexcept {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size() && i < sizeof number; ++i) {
    number |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  }
  return number;
}

/// Returns the `width` lowest bytes of a number, lowest byte first.
inline std::vector<std::byte> little_endian(std::int64_t value, unsigned width) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < width; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  return bytes;
}

}  // namespace takt
