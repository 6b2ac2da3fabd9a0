#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace takt {

/// Blanks, tabs, control characters: NUL and Ctrl-Z at the end of old files too.
constexpr bool is_blank(char c) noexcept { return static_cast<unsigned char>(c) <= 0x20; }

constexpr char fold(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

constexpr std::string_view trim(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// ASCII, not case sensitive; `lower` must be in lower case.
constexpr bool same_word(std::string_view text, std::string_view lower) noexcept {
  if (text.size() != lower.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (fold(text[i]) != lower[i]) return false;
  }
  return true;
}

/// Value of a hex digit, or -1.
constexpr int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  const char low = fold(c);
  return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

/// Without an inline comment (`;...` or `#...`). Not for texts, where both are part of the value.
std::string_view without_comment(std::string_view value) noexcept;

bool is_utf8(std::string_view text) noexcept;
/// The text as UTF-8; what is not UTF-8 already is taken for Windows-1252.
std::string to_utf8(std::string_view text);
/// Without surrogate pairs' worth of care: unpaired surrogates become U+FFFD.
std::string utf16_to_utf8(std::string_view bytes, bool big_endian);
/// For UNICODE_STRING on the wire: UTF-16, little endian.
std::string utf8_to_utf16le(std::string_view text);

/// `text` cut to a length that fits a message, in quotes.
std::string quoted(std::string_view text);

}  // namespace takt
