#include "apps/takt/live/text/character_width.hpp"

#include <algorithm>
#include <array>

namespace takt {
namespace {

struct Range {
  char32_t first;
  char32_t last;
};

/// Combining marks, and characters without a glyph. Unicode, general categories Mn, Me and Cf.
constexpr std::array without_columns{
    Range{0x0300, 0x036F}, Range{0x0483, 0x0489},  Range{0x0591, 0x05BD}, Range{0x0610, 0x061A},
    Range{0x064B, 0x065F}, Range{0x1AB0, 0x1AFF},  Range{0x1DC0, 0x1DFF}, Range{0x200B, 0x200F},
    Range{0x2060, 0x2064}, Range{0x20D0, 0x20F0},  Range{0xFE00, 0xFE0F}, Range{0xFE20, 0xFE2F},
    Range{0xFEFF, 0xFEFF}, Range{0xE0100, 0xE01EF}};

/// Unicode, East Asian Width W and F.
constexpr std::array with_two_columns{
    Range{0x1100, 0x115F},   Range{0x2E80, 0x303E},   Range{0x3041, 0xA4CF},
    Range{0xA960, 0xA97C},   Range{0xAC00, 0xD7A3},   Range{0xF900, 0xFAFF},
    Range{0xFE30, 0xFE6F},   Range{0xFF00, 0xFF60},   Range{0xFFE0, 0xFFE6},
    Range{0x1F300, 0x1F64F}, Range{0x1F680, 0x1F6FF}, Range{0x1F900, 0x1FAFF},
    Range{0x20000, 0x3FFFD}};

template <std::size_t size>
bool is_in(const std::array<Range, size>& ranges, char32_t character) noexcept {
  return std::ranges::any_of(ranges, [character](const Range& range) {
    return character >= range.first && character <= range.last;
  });
}

bool continues(char byte) noexcept { return (static_cast<unsigned char>(byte) & 0xC0) == 0x80; }

}  // namespace

FirstCharacter first_character(std::string_view text) noexcept {
  if (text.empty()) return {};
  const auto lead = static_cast<unsigned char>(text.front());
  std::size_t bytes = 1;
  while (bytes < text.size() && bytes < 4 && continues(text[bytes])) ++bytes;
  if (bytes == 1) return {.bytes = 1, .columns = 1};
  char32_t character = lead & (0xFFU >> (bytes + 1));
  for (const char byte : text.substr(1, bytes - 1)) {
    character = character << 6 | (static_cast<unsigned char>(byte) & 0x3FU);
  }
  if (is_in(without_columns, character)) return {.bytes = bytes, .columns = 0};
  return {.bytes = bytes, .columns = is_in(with_two_columns, character) ? 2U : 1U};
}

std::size_t columns_of(std::string_view text) noexcept {
  std::size_t columns = 0;
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    columns += first.columns;
    text.remove_prefix(first.bytes);
  }
  return columns;
}

std::string_view first_columns(std::string_view text, std::size_t columns) noexcept {
  std::size_t bytes = 0;
  while (bytes < text.size()) {
    const FirstCharacter next = first_character(text.substr(bytes));
    if (next.columns > columns) break;
    columns -= next.columns;
    bytes += next.bytes;
  }
  return text.substr(0, bytes);
}

std::string_view last_columns(std::string_view text, std::size_t columns) noexcept {
  std::size_t left = columns_of(text);
  while (left > columns) {
    const FirstCharacter first = first_character(text);
    left -= first.columns;
    text.remove_prefix(first.bytes);
  }
  return text;
}

}  // namespace takt
