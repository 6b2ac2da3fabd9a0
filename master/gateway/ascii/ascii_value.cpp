#include "master/gateway/ascii/ascii_value.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include "eds_parser/values/number_in.hpp"
#include "master/gateway/message/value_text.hpp"
#include "master/lcm/messages.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr int padded = sodium_base64_VARIANT_ORIGINAL;

std::string base64(std::span<const std::byte> bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), padded), '\0');
  ::sodium_bin2base64(text.data(), text.size(), octets(bytes).data(), bytes.size(), padded);
  text.pop_back();  // the zero at the end
  return text;
}

std::expected<std::vector<std::byte>, std::string> from_base64(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::size_t size = 0;
  if (::sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(),
                          text.size(), nullptr, &size, nullptr, padded) != 0) {
    return std::unexpected{std::string{"this is not base64"}};
  }
  bytes.resize(size);
  return bytes;
}

/// Quotes a string and escapes control characters, which must not break the line.
std::string quoted(std::span<const std::byte> bytes) {
  std::string text{'"'};
  for (const std::uint8_t c : octets(bytes)) {
    if (c == '"') {
      text += "\"\"";
    } else if (c < 0x20 || c == 0x7F) {
      text += fmt::format("\\x{:02X}", c);
    } else {
      text += static_cast<char>(c);
    }
  }
  return text + '"';
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
      if (is_bytes(type.type)) return fmt::format("{:02X}", fmt::join(octets(bytes), " "));
      return fmt::format("0x{:0{}X}", load_le<std::uint64_t>(bytes), 2 * bytes.size());
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
  const auto value = number_in<std::uint64_t>(word, hex ? 16 : 10);
  if (!value) return {};
  return static_cast<std::int64_t>(negative ? 0 - *value : *value);
}

}  // namespace takt
