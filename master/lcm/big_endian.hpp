#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace takt {

/// Reads an integer from the first sizeof(T) bytes, most significant byte first, as LCM sends it.
/// From fewer bytes, reads a shorter integer.
template <class T>
T load_be(std::span<const std::byte> bytes) noexcept {
  std::uint64_t value = 0;
  for (const std::byte byte : bytes.first(std::min(sizeof(T), bytes.size()))) {
    value = value << 8 | std::to_integer<std::uint64_t>(byte);
  }
  return static_cast<T>(value);
}

/// Appends an integer, most significant byte first.
template <class T>
void append_be(std::vector<std::byte>& out, T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof value>>(value);
  if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(bytes);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace takt
