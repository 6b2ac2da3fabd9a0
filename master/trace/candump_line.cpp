#include "master/trace/candump_line.hpp"

#include <fmt/format.h>
#include <span>
#include <vector>

#include "eds_parser/values/number_in.hpp"
#include "master/trace/words.hpp"

namespace takt {
namespace {

constexpr std::uint32_t error_flag = 0x2000'0000;

/// Reads an identifier. Three digits are an 11-bit identifier; eight digits are a 29-bit identifier
/// or the class of an error frame.
bool read_id(std::string_view text, CandumpLine& line) {
  const auto id = number_in<std::uint32_t>(text, 16);
  if (!id || (text.size() != 3 && text.size() != 8)) return false;
  line.error_frame = text.size() == 8 && (*id & error_flag) != 0;
  line.frame.id = text.size() == 8 ? CobId::extended(*id) : CobId::base(*id);
  return true;
}

bool add_byte(std::string_view text, Frame& frame) {
  const auto byte = number_in<std::uint8_t>(text, 16);
  if (!byte || text.size() != 2 || frame.length == 8) return false;
  frame.data[frame.length++] = *byte;
  return true;
}

/// Reads a frame like `185#3706`, `705#R` or `705#R1`. Dots between bytes are allowed.
bool read_log_frame(std::string_view text, CandumpLine& line) {
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos || !read_id(text.substr(0, hash), line)) return false;
  text.remove_prefix(hash + 1);
  if (text.starts_with('#')) return false;  // CAN FD
  if (text.starts_with('R') || text.starts_with('r')) {
    line.frame.rtr = true;
    const auto length = text.size() == 1 ? 0 : number_in<std::uint8_t>(text.substr(1), 10);
    if (!length || *length > 8) return false;
    line.frame.length = *length;
    return true;
  }
  while (!text.empty()) {
    if (text.starts_with('.')) text.remove_prefix(1);
    if (!add_byte(text.substr(0, 2), line.frame)) return false;
    text.remove_prefix(2);
  }
  return true;
}

/// Reads a frame like `185 [2] 37 06` or `705 [1] remote request`.
bool read_terminal_frame(std::span<const std::string_view> words, CandumpLine& line) {
  if (words.size() < 2 || !read_id(words[0], line)) return false;
  const std::string_view bracket = words[1];
  if (bracket.size() != 3 || bracket[0] != '[' || bracket[2] != ']') return false;
  const auto length = number_in<std::uint8_t>(bracket.substr(1, 1), 10);
  if (!length || *length > 8) return false;
  if (words.size() >= 4 && words[2] == "remote") {
    line.frame.rtr = true;
    line.frame.length = *length;
    return true;
  }
  if (words.size() < 2U + *length) return false;
  for (std::size_t i = 0; i < *length; ++i) {
    if (!add_byte(words[2 + i], line.frame)) return false;
  }
  return true;
}

/// Removes the colours that the option `-c` of candump adds.
std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\x1b') {
      plain += text[i];
      continue;
    }
    while (i < text.size() && text[i] != 'm') ++i;
  }
  return plain;
}

/// Reads a time stamp like `(1436509052.249713)`, or `(2015-07-10 08:17:32.249713)` with the option
/// `-tA`. Returns true if the line has no time stamp, and false if a time stamp has no end.
bool read_stamp(std::span<const std::string_view>& words, CandumpLine& line) {
  if (words.empty() || !words[0].starts_with('(')) return true;
  const std::size_t count = words[0].ends_with(')') ? 1 : 2;
  if (words.size() < count || !words[count - 1].ends_with(')')) return false;
  const char* const begin = words[0].data() + 1;
  const char* const end = words[count - 1].data() + words[count - 1].size() - 1;
  line.stamp.assign(begin, end);
  words = words.subspan(count);
  return true;
}

/// Removes the direction and the flags that the option `-x` shows before the identifier: `RX - -`,
/// `TX B -`.
std::span<const std::string_view> without_direction(std::span<const std::string_view> words) {
  if (words.empty() || (words[0] != "RX" && words[0] != "TX")) return words;
  words = words.subspan(1);
  while (!words.empty() && words[0].size() == 1) words = words.subspan(1);
  return words;
}

}  // namespace

std::optional<CandumpLine> parse_candump(std::string_view text) {
  const bool coloured = text.find('\x1b') != std::string_view::npos;
  const std::string plain = coloured ? without_escapes(text) : std::string{};
  const std::vector<std::string_view> all = words_of(coloured ? plain : text);
  CandumpLine line;
  std::span<const std::string_view> words{all};
  if (!read_stamp(words, line)) return {};
  if (words.size() < 2) return {};
  line.interface = words[0];
  words = without_direction(words.subspan(1));
  if (words.empty()) return {};
  const bool log = words[0].find('#') != std::string_view::npos;
  if (!(log ? read_log_frame(words[0], line) : read_terminal_frame(words, line))) return {};
  return line;
}

std::string to_string(const CandumpLine& line) {
  const Frame& frame = line.frame;
  std::string out = line.stamp.empty() ? "" : fmt::format("({})  ", line.stamp);
  out += line.interface;
  const std::uint32_t flag = line.error_frame ? error_flag : 0;
  out += frame.id.is_extended() ? fmt::format("  {:08X}", frame.id.id() | flag)
                                : fmt::format("  {:03X}", frame.id.id());
  out += fmt::format("   [{}] ", frame.length);
  if (frame.rtr) return out + " remote request";
  for (const std::uint8_t byte : frame.payload()) out += fmt::format(" {:02X}", byte);
  return out;
}

}  // namespace takt
