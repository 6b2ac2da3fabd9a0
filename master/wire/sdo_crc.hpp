#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "master/wire/bytes.hpp"

namespace takt {

namespace sdo_detail {

/// Returns the table of the polynomial x^16 + x^12 + x^5 + 1, most significant bit first.
constexpr std::array<std::uint16_t, 256> make_crc_table() noexcept {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned crc = byte << 8;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}
inline constexpr auto crc_table = make_crc_table();

}  // namespace sdo_detail

/// Returns the CRC of SDO block transfers. Start with `crc` = 0; to continue over several pieces,
/// pass the result of the piece before. CiA 301, 7.2.4.3.16.
template <WireByte B, std::size_t N>
constexpr std::uint16_t sdo_crc(std::span<B, N> bytes, std::uint16_t crc = 0) noexcept {
  for (const B byte : bytes) {
    const unsigned place = (crc >> 8 ^ static_cast<unsigned>(byte)) & 0xFFU;
    crc = static_cast<std::uint16_t>(crc << 8 ^ sdo_detail::crc_table[place]);
  }
  return crc;
}

}  // namespace takt
