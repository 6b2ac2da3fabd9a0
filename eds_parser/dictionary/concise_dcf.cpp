#include "eds_parser/dictionary/concise_dcf.hpp"

#include <cstdint>
#include <utility>

namespace takt {
namespace {

constexpr std::size_t entry_head = 7;  // bytes of index, sub-index and length

std::uint32_t number(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  }
  return value;
}

void append(std::vector<std::byte>& out, std::uint32_t value, unsigned width) {
  for (unsigned i = 0; i < width; ++i) {
    out.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFF));
  }
}

std::unexpected<std::string> truncated(std::size_t entry, std::size_t entries) {
  return std::unexpected{"ends within entry " + std::to_string(entry) + " of " +
                         std::to_string(entries)};
}

}  // namespace

std::expected<std::vector<ConciseEntry>, std::string> decode_concise_dcf(
    std::span<const std::byte> bytes) {
  std::vector<ConciseEntry> entries;
  if (bytes.empty()) return entries;
  if (bytes.size() < 4) return std::unexpected{"lacks its number of entries (4 bytes)"};
  const std::uint32_t count = number(bytes.first(4));
  bytes = bytes.subspan(4);
  for (std::uint32_t i = 1; i <= count; ++i) {
    if (bytes.size() < entry_head) return truncated(i, count);
    ConciseEntry entry{.object = {static_cast<std::uint16_t>(number(bytes.first(2))),
                                  std::to_integer<std::uint8_t>(bytes[2])},
                       .value = {}};
    const std::uint32_t size = number(bytes.subspan(3, 4));
    bytes = bytes.subspan(entry_head);
    if (bytes.size() < size) return truncated(i, count);
    entry.value.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    bytes = bytes.subspan(size);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<std::byte> encode_concise_dcf(std::span<const ConciseEntry> entries) {
  std::vector<std::byte> out;
  append(out, static_cast<std::uint32_t>(entries.size()), 4);
  for (const ConciseEntry& entry : entries) {
    append(out, entry.object.index, 2);
    append(out, entry.object.sub, 1);
    append(out, static_cast<std::uint32_t>(entry.value.size()), 4);
    out.insert(out.end(), entry.value.begin(), entry.value.end());
  }
  return out;
}

}  // namespace takt
