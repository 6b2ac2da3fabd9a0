#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace takt {

/// Returns true for blanks, tabs and control characters. These include NUL and Ctrl-Z, which some
/// old files have at the end.
constexpr bool is_blank(char c) noexcept { return static_cast<unsigned char>(c) <= 0x20; }

constexpr char fold(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

constexpr std::string_view trim(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Compares ASCII text without regard to case. `lower` must be in lower case.
constexpr bool same_word(std::string_view text, std::string_view lower) noexcept {
  if (text.size() != lower.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (fold(text[i]) != lower[i]) return false;
  }
  return true;
}

/// Returns true if the text begins with a word, without regard to case. `lower` must be in lower
/// case.
constexpr bool has_prefix(std::string_view text, std::string_view lower) noexcept {
  return same_word(text.substr(0, lower.size()), lower);
}

/// Returns true for `0x1F` or `0X1F`. `0x` alone is no number.
constexpr bool is_prefixed_hex(std::string_view text) noexcept {
  return text.size() > 2 && has_prefix(text, "0x");
}

/// Returns the value of a hexadecimal digit, or -1 if `c` is none.
constexpr int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  const char low = fold(c);
  return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

/// Returns the value of hexadecimal digits without `0x`, or std::nullopt if the text has another
/// character or needs more than 32 bits.
std::optional<std::uint32_t> hex_digits(std::string_view text) noexcept;

/// Returns the value without an inline comment (`;...` or `#...`). Do not use it for texts, in
/// which both characters are part of the value.
std::string_view without_comment(std::string_view value) noexcept;

bool is_utf8(std::string_view text) noexcept;
/// Returns the text as UTF-8. A text that is not UTF-8 already is read as Windows-1252.
std::string to_utf8(std::string_view text);
/// Converts UTF-16 to UTF-8. Unpaired surrogates become U+FFFD.
std::string utf16_to_utf8(std::string_view bytes, bool big_endian);
/// Converts UTF-8 to UTF-16, little endian, for UNICODE_STRING on the wire.
std::string utf8_to_utf16le(std::string_view text);

/// Returns the shortest text that reads back as the same number.
std::string real_text(double value);

/// Returns `text` in quotes, shortened so that it fits into a message.
std::string quoted(std::string_view text);

}  // namespace takt
