#include "master/gateway/message/value_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "eds_parser/values/number_in.hpp"
#include "eds_parser/values/raw_number.hpp"
#include "master/lcm/messages.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

using enum DataType;
using Named = std::pair<std::string_view, DataType>;
constexpr Named short_names[] = {
    {"b", boolean},         {"bool", boolean},     {"i8", integer8},
    {"i16", integer16},     {"i24", integer24},    {"i32", integer32},
    {"i40", integer40},     {"i48", integer48},    {"i56", integer56},
    {"i64", integer64},     {"u8", unsigned8},     {"u16", unsigned16},
    {"u24", unsigned24},    {"u32", unsigned32},   {"u40", unsigned40},
    {"u48", unsigned48},    {"u56", unsigned56},   {"u64", unsigned64},
    {"x8", unsigned8},      {"x16", unsigned16},   {"x32", unsigned32},
    {"x64", unsigned64},    {"r32", real32},       {"r64", real64},
    {"f32", real32},        {"f64", real64},       {"string", visible_string},
    {"vs", visible_string}, {"hex", octet_string}, {"os", octet_string},
    {"domain", domain},     {"d", domain}};

std::string lower(std::string_view text) {
  std::string copy{text};
  std::ranges::transform(copy, copy.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return copy;
}

bool printable(std::span<const std::byte> bytes) noexcept {
  return !bytes.empty() && std::ranges::all_of(bytes, [](std::byte byte) {
    const int c = std::to_integer<int>(byte);
    return c >= 0x20 && c < 0x7F;
  });
}

std::string string_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> wire_bytes(std::uint64_t value, unsigned size) {
  std::array<std::byte, 8> bytes;
  store_le(std::span{bytes}, value);
  return {bytes.begin(), bytes.begin() + size};
}

std::optional<std::uint64_t> parse_integer(std::string_view text, bool& negative) {
  negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (hexadecimal) text.remove_prefix(2);
  return number_in<std::uint64_t>(text, hexadecimal ? 16 : 10);
}

std::expected<std::vector<std::byte>, std::string> integer_bytes(DataType type,
                                                                 const std::string& text) {
  bool negative = false;
  const auto magnitude = parse_integer(text, negative);
  if (!magnitude) return std::unexpected{"'" + text + "' is not an integer (decimal or 0x hex)"};
  const unsigned bits = bit_width(type);
  const std::uint64_t limit = is_signed(type)
                                  ? (std::uint64_t{1} << (bits - 1)) - (negative ? 0 : 1)
                                  : (negative ? 0 : ~std::uint64_t{0} >> (64 - bits));
  // Users write 0xFFFE for an INTEGER16 as a bit pattern.
  const bool pattern = !negative && text.starts_with("0x") && bits < 64 && *magnitude >> bits == 0;
  if (*magnitude > limit && !pattern) {
    return std::unexpected{text + " does not fit " + std::string{name(type)}};
  }
  return wire_bytes(negative ? 0 - *magnitude : *magnitude, byte_width(type));
}

std::expected<std::vector<std::byte>, std::string> real_bytes(DataType type,
                                                              const std::string& text) {
  const auto value = number_in<double>(text);
  if (!value) return std::unexpected{"'" + text + "' is not a number"};
  if (type == DataType::real64) return wire_bytes(std::bit_cast<std::uint64_t>(*value), 8);
  if (exceeds_real32(*value)) return std::unexpected{text + " does not fit REAL32"};
  return wire_bytes(std::bit_cast<std::uint32_t>(static_cast<float>(*value)), 4);
}

std::expected<std::vector<std::byte>, std::string> hex_bytes(const std::string& text) {
  std::vector<std::byte> bytes;
  std::string digits = text;
  std::erase_if(digits, [](char c) { return c == ' ' || c == ':'; });
  if (digits.starts_with("0x")) digits.erase(0, 2);
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto value = number_in<std::uint8_t>(std::string_view{digits}.substr(i, 2), 16);
    if (!value || digits.size() % 2 != 0) {
      return std::unexpected{"'" + text + "' is not an even number of hex digits"};
    }
    bytes.push_back(std::byte{*value});
  }
  return bytes;
}

}  // namespace

std::optional<DataType> parse_data_type(std::string_view text) {
  const std::string wanted = lower(text);
  const auto found = std::ranges::find(short_names, wanted, &Named::first);
  if (found != std::end(short_names)) return found->second;
  for (std::uint16_t code = 1; code <= 0x1B; ++code) {
    const auto type = static_cast<DataType>(code);
    if (lower(name(type)) == wanted && name(type) != name(DataType::unknown)) return type;
  }
  return std::nullopt;
}

std::string hex_text(std::span<const std::byte> bytes) {
  return fmt::format("{:02X}", fmt::join(octets(bytes), ""));
}

bool fits(DataType type, std::span<const std::byte> bytes) noexcept {
  return is_bytes(type) || bytes.size() == byte_width(type);
}

std::string misfit_text(std::string_view name, DataType type, std::span<const std::byte> bytes) {
  constexpr std::size_t shown = 16;
  const bool long_value = bytes.size() > shown;
  return fmt::format(
      "the device sent {} bytes ({}{}), {} takes {}; without a type the bytes are shown unchanged",
      bytes.size(), hex_text(bytes.first(std::min(shown, bytes.size()))), long_value ? " ..." : "",
      name, byte_width(type));
}

std::string value_text(DataType type, std::span<const std::byte> bytes) {
  if (type == DataType::visible_string) return string_of(bytes);
  if (is_bytes(type)) return hex_text(bytes);
  const std::uint64_t value = load_le<std::uint64_t>(bytes);
  if (is_real(type)) return fmt::format("{}", number_of(type, static_cast<std::int64_t>(value)));
  if (is_signed(type)) return std::to_string(sign_extended(value, bit_width(type)));
  return std::to_string(value);
}

std::string untyped_text(std::span<const std::byte> bytes) {
  if (bytes.empty()) return "(empty)";
  if (printable(bytes) && bytes.size() > 4) return string_of(bytes);
  if (bytes.size() > 8) return hex_text(bytes);
  const std::uint64_t value = load_le<std::uint64_t>(bytes);
  std::string text = fmt::format("{}  0x{:0{}X}", value, value, bytes.size() * 2);
  const std::int64_t as_signed = sign_extended(value, static_cast<unsigned>(bytes.size()) * 8);
  if (as_signed < 0) text += fmt::format("  signed {}", as_signed);
  if (printable(bytes)) text += "  \"" + string_of(bytes) + "\"";
  return text;
}

std::expected<std::vector<std::byte>, std::string> value_bytes(DataType type,
                                                               const std::string& text) {
  if (type == DataType::boolean) {
    if (text == "true" || text == "1") return wire_bytes(1, 1);
    if (text == "false" || text == "0") return wire_bytes(0, 1);
    return std::unexpected{"'" + text + "' is not 0, 1, true or false"};
  }
  if (type == DataType::visible_string) {
    const auto bytes = std::as_bytes(std::span{text});
    return std::vector<std::byte>{bytes.begin(), bytes.end()};
  }
  if (is_bytes(type)) return hex_bytes(text);
  if (is_real(type)) return real_bytes(type, text);
  return integer_bytes(type, text);
}

}  // namespace takt
