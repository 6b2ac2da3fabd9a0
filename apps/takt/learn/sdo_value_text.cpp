#include "apps/takt/learn/sdo_value_text.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/raw_number.hpp"

namespace takt::learn {
namespace {

constexpr std::size_t longest_text = 4096;

/// Returns the bytes in quotes. YAML has an escape for every character, but a byte above 0x7F would
/// become two bytes in UTF-8; returns std::nullopt for these.
std::optional<std::string> quoted(std::span<const std::uint8_t> bytes) {
  const auto ascii = [](std::uint8_t c) { return c < 0x80; };
  if (bytes.empty() || bytes.size() > longest_text || !std::ranges::all_of(bytes, ascii)) return {};
  std::string out = "\"";
  for (const std::uint8_t c : bytes) {
    if (c < 0x20 || c == 0x7F) {
      out += fmt::format("\\x{:02X}", c);
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += static_cast<char>(c);
    }
  }
  return out + '"';
}

std::optional<std::string> real_text(double value) {
  if (!std::isfinite(value)) return {};
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

bool is_longer_than(std::span<const std::uint8_t> bytes, DataType type) {
  const std::size_t size = byte_width(type);
  if (is_bytes(type) || bytes.size() <= size) return false;
  const bool negative = is_signed(type) && (bytes[size - 1] & 0x80U) != 0;
  const auto filled_with = [&](std::uint8_t filler) {
    return std::ranges::all_of(bytes.subspan(size), [=](std::uint8_t b) { return b == filler; });
  };
  return !filled_with(0) && !(negative && filled_with(0xFF));
}

std::optional<std::string> sdo_value_text(std::span<const std::uint8_t> bytes, DataType type) {
  if (is_bytes(type)) return quoted(bytes);
  if (bytes.empty() || bytes.size() > 8 || is_longer_than(bytes, type)) return {};
  const std::uint64_t raw = from_little_endian(std::as_bytes(bytes));
  if (type == DataType::real32) {
    return real_text(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  }
  if (type == DataType::real64) return real_text(std::bit_cast<double>(raw));
  if (type == DataType::boolean && raw > 1) return {};
  const unsigned bits = bit_width(type);
  const std::uint64_t cut = bits == 64 ? raw : raw & ((std::uint64_t{1} << bits) - 1);
  if (is_signed(type)) return std::to_string(sign_extended(cut, bits));
  if (cut > static_cast<std::uint64_t>(INT64_MAX)) return {};
  return std::to_string(cut);
}

}  // namespace takt::learn
