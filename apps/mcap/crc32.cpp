#include "apps/mcap/crc32.hpp"

#include <array>

namespace takt::mcap {
namespace {

constexpr std::array<std::uint32_t, 256> make_table() noexcept {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xEDB88320U : 0U);
    table[byte] = value;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> table = make_table();

}  // namespace

void Crc32::add(std::string_view bytes) noexcept {
  for (const char byte : bytes) {
    state_ = (state_ >> 8) ^ table[(state_ ^ static_cast<unsigned char>(byte)) & 0xFFU];
  }
}

std::uint32_t crc32(std::string_view bytes) noexcept {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace takt::mcap
