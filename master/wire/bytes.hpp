#pragma once
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace takt {

/// A type of byte: frames hold std::uint8_t, values hold std::byte.
template <class B>
concept WireByte = sizeof(B) == 1 && (std::same_as<std::remove_const_t<B>, std::byte> ||
                                      std::same_as<std::remove_const_t<B>, std::uint8_t>);

/// Reads an integer from the first sizeof(T) bytes, least significant byte first. Missing bytes
/// count as zero. CiA 301, 7.1.4.
template <std::unsigned_integral T, WireByte B, std::size_t N>
constexpr T load_le(std::span<B, N> bytes) noexcept {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T) && i < bytes.size(); ++i) {
    value = static_cast<T>(value | static_cast<T>(static_cast<T>(bytes[i]) << (8 * i)));
  }
  return value;
}

/// Writes `value` to the first sizeof(T) bytes, least significant byte first.
template <std::unsigned_integral T, WireByte B, std::size_t N>
constexpr void store_le(std::span<B, N> bytes, T value) noexcept {
  assert(bytes.size() >= sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[i] = static_cast<B>(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

}  // namespace takt
