#include "apps/learn/sdo_value_text.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "apps/learn/yaml_text.hpp"

namespace takt {
namespace {

std::uint64_t little_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | bytes[i];
  return value;
}

std::optional<std::string> quoted(std::span<const std::uint8_t> bytes) {
  const auto printable = [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; };
  if (bytes.empty() || !std::ranges::all_of(bytes, printable)) return {};
  std::size_t first = 0;
  while (first < bytes.size() && (bytes[first] == '+' || bytes[first] == '-')) ++first;
  if (first < 2 && first < bytes.size() && std::isdigit(bytes[first]) != 0) return {};
  return yaml_quoted(std::string{bytes.begin(), bytes.end()});
}

std::optional<std::string> real_text(double value) {
  if (!std::isfinite(value)) return {};
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::optional<std::string> sdo_value_text(std::span<const std::uint8_t> bytes, DataType type) {
  if (is_bytes(type)) return quoted(bytes);
  if (bytes.empty() || bytes.size() > 8) return {};
  const std::uint64_t raw = little_endian(bytes);
  if (type == DataType::real32) {
    const double value = std::bit_cast<float>(static_cast<std::uint32_t>(raw));
    return real_text(value);
  }
  if (type == DataType::real64) return real_text(std::bit_cast<double>(raw));
  const unsigned bits = bit_width(type);
  const std::uint64_t cut = bits == 64 ? raw : raw & ((std::uint64_t{1} << bits) - 1);
  if (is_signed(type)) {
    const unsigned unused = 64 - bits;
    return std::to_string(static_cast<std::int64_t>(cut << unused) >> unused);
  }
  if (cut > static_cast<std::uint64_t>(INT64_MAX)) return {};
  return std::to_string(cut);
}

}  // namespace takt
