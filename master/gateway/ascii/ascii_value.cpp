#include "master/gateway/ascii/ascii_value.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "master/gateway/message/value_text.hpp"

namespace takt {
namespace {

constexpr std::string_view digits64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view digits16 = "0123456789ABCDEF";

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < left ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= left ? digits64[group >> (18 - 6 * k) & 0x3F] : '=';
    }
  }
  return text;
}

std::expected<std::vector<std::byte>, std::string> from_base64(std::string_view text) {
  std::vector<std::byte> bytes;
  std::uint32_t group = 0;
  unsigned bits = 0;
  const std::size_t end = text.find_last_not_of('=') + 1;
  if (text.size() % 4 != 0 || text.size() - end > 2) {
    return std::unexpected{std::string{"base64 comes in groups of four characters"}};
  }
  for (const char c : text.substr(0, end)) {
    const std::size_t digit = digits64.find(c);
    if (digit == digits64.npos) return std::unexpected{std::string{"this is no base64"}};
    group = (group << 6 | static_cast<std::uint32_t>(digit)) & 0xFF'FFFF;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::byte>(group >> bits & 0xFF));
  }
  return bytes;
}

/// Quotes a string and escapes control characters, which must not break the line.
std::string quoted(std::span<const std::byte> bytes) {
  std::string text{'"'};
  for (const std::byte byte : bytes) {
    const auto c = std::to_integer<unsigned char>(byte);
    if (c == '"') {
      text += "\"\"";
    } else if (c < 0x20 || c == 0x7F) {
      text += {'\\', 'x', digits16[c >> 4], digits16[c & 0xF]};
    } else {
      text += static_cast<char>(c);
    }
  }
  return text + '"';
}

std::string hex_number(std::span<const std::byte> bytes) {
  std::string text = "0x";
  for (std::size_t i = bytes.size(); i-- > 0;) {
    text += digits16[std::to_integer<std::size_t>(bytes[i]) >> 4];
    text += digits16[std::to_integer<std::size_t>(bytes[i]) & 0xF];
  }
  return text;
}

std::string hex_bytes_text(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    if (!text.empty()) text += ' ';
    text += digits16[std::to_integer<std::size_t>(byte) >> 4];
    text += digits16[std::to_integer<std::size_t>(byte) & 0xF];
  }
  return text;
}

}  // namespace

std::optional<AsciiType> parse_ascii_type(std::string_view name) {
  using enum AsciiType::Form;
  if (name == "vs") return AsciiType{DataType::visible_string, quoted};
  if (name == "os") return AsciiType{DataType::octet_string, base64};
  if (name == "us") return AsciiType{DataType::unicode_string, base64};
  if (name == "d") return AsciiType{DataType::domain, base64};
  if (name == "hex") return AsciiType{DataType::domain, hex};
  const auto type = name.empty() ? std::nullopt : parse_data_type(name);
  if (!type || is_bytes(*type) || byte_width(*type) == 6) return {};
  if (name != "b" && !std::string_view{"iuxr"}.contains(name[0])) return {};
  if (name != "b" && name.find_first_not_of("0123456789", 1) != name.npos) return {};
  return AsciiType{*type, name[0] == 'x' ? hex : plain};
}

std::expected<std::vector<std::byte>, std::string> ascii_bytes(AsciiType type,
                                                               const std::string& word) {
  if (type.form == AsciiType::Form::base64) return from_base64(word);
  return value_bytes(type.type, word);
}

std::optional<std::string> ascii_text(AsciiType type, std::span<const std::byte> bytes) {
  if (!fits(type.type, bytes)) return {};
  switch (type.form) {
    case AsciiType::Form::plain:
      return value_text(type.type, bytes);
    case AsciiType::Form::hex:
      return is_bytes(type.type) ? hex_bytes_text(bytes) : hex_number(bytes);
    case AsciiType::Form::quoted:
      return quoted(bytes);
    case AsciiType::Form::base64:
      return base64(bytes);
  }
  return {};
}

std::optional<std::int64_t> parse_ascii_integer(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  const bool hex = word.starts_with("0x") || word.starts_with("0X");
  if (hex) word.remove_prefix(2);
  if (word.empty() || (!hex && word.size() > 1 && word[0] == '0')) return {};
  std::uint64_t value = 0;
  const auto [end, error] =
      std::from_chars(word.data(), word.data() + word.size(), value, hex ? 16 : 10);
  if (error != std::errc{} || end != word.data() + word.size()) return {};
  return static_cast<std::int64_t>(negative ? 0 - value : value);
}

}  // namespace takt
