#include "apps/takt/live/text/drive_words.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <takt/drive402.hpp>
#include <utility>

#include "apps/axis/group/speed_pattern.hpp"

namespace takt {
namespace {

bool has(std::uint16_t word, unsigned bit) noexcept { return (word >> bit & 1U) != 0; }

void add_word(std::string& text, std::string_view word) {
  if (!text.empty()) text += ", ";
  text += word;
}

/// Meanings of two bits of a word in one mode of operation. An empty text means that the bit has no
/// meaning.
struct ModeBits {
  int mode;
  std::string_view low;
  std::string_view high;
};

/// Bits 12 and 13 of the statusword.
constexpr std::array status_bits{
    ModeBits{1, "set-point acknowledged", "following error"},
    ModeBits{3, "speed 0", "slippage error"},
    ModeBits{6, "homing attained", "homing error"},
    ModeBits{7, "interpolates", ""},
    ModeBits{8, "follows the target", "following error"},
    ModeBits{9, "follows the target", ""},
    ModeBits{10, "follows the target", ""},
};

/// Bits 4 and 5 of the controlword.
constexpr std::array control_bits{
    ModeBits{1, "new set-point", "at once"},
    ModeBits{6, "homing start", ""},
    ModeBits{7, "interpolation", ""},
};

template <std::size_t size>
std::pair<std::string_view, std::string_view> words_of(const std::array<ModeBits, size>& table,
                                                       int mode) {
  const auto found = std::ranges::find(table, mode, &ModeBits::mode);
  if (found == table.end()) return {};
  return {found->low, found->high};
}

/// Adds the word of a bit that is set, or its number if it has no word.
void add_bit(std::string& text, std::uint16_t word, unsigned bit, std::string_view meaning) {
  if (has(word, bit))
    add_word(text, meaning.empty() ? "bit " + std::to_string(bit) : std::string{meaning});
}

}  // namespace

std::string statusword_text(std::uint16_t statusword, int mode) {
  const auto state = decode_statusword(statusword);
  std::string text{state ? name(*state) : "no state of CiA 402"};
  if (has(statusword, 7)) add_word(text, "warning");
  add_word(text, has(statusword, 4) ? "voltage" : "no voltage");
  add_word(text, has(statusword, 9) ? "remote" : "not remote");
  add_bit(text, statusword, 10, "target reached");
  add_bit(text, statusword, 11, "internal limit");
  const auto [low, high] = words_of(status_bits, mode);
  add_bit(text, statusword, 12, low);
  add_bit(text, statusword, 13, high);
  for (const unsigned bit : {8U, 14U, 15U}) add_bit(text, statusword, bit, {});
  return text;
}

std::string controlword_text(std::uint16_t controlword, int mode) {
  std::string text;
  if (has(controlword, 7)) add_word(text, "fault reset");
  if (!has(controlword, 1)) {
    add_word(text, "disable voltage");
  } else if (!has(controlword, 2)) {
    add_word(text, "quick stop");
  } else if (!has(controlword, 0)) {
    add_word(text, "shutdown");
  } else {
    add_word(text, has(controlword, 3) ? "enable operation" : "switch on");
  }
  if (has(controlword, 8)) add_word(text, "halt");
  const auto [low, high] = words_of(control_bits, mode);
  add_bit(text, controlword, 4, low);
  add_bit(text, controlword, 5, high);
  add_bit(text, controlword, 6, mode == 1 ? "relative" : "");
  for (unsigned bit = 9; bit < 16; ++bit) add_bit(text, controlword, bit, {});
  return text;
}

std::string mode_text(int mode) {
  static constexpr std::array<std::string_view, 12> modes{
      "none", "pp", "vl", "pv", "tq", "", "hm", "ip", "csp", "csv", "cst", "cstca"};
  const bool named = mode >= 0 && static_cast<std::size_t>(mode) < modes.size();
  if (!named || modes[static_cast<std::size_t>(mode)].empty()) return std::to_string(mode);
  return std::string{modes[static_cast<std::size_t>(mode)]};
}

std::string speed_words(const speed_axis_t& axis, std::uint16_t word) {
  std::string text;
  if (shows(axis.fault, word)) add_word(text, "fault");
  if (shows(axis.ready, word)) add_word(text, "ready");
  if (shows(axis.running, word)) add_word(text, "running");
  if (shows(axis.reverse, word)) add_word(text, "backward");
  if (shows(axis.at_speed, word)) add_word(text, "at speed");
  if (shows(axis.standstill, word)) add_word(text, "standstill");
  return text.empty() ? "no known state" : text;
}

std::string speed_command(const speed_axis_t& axis, std::uint16_t word) {
  if (word == axis.run) return "run";
  if (word == axis.run_reverse) return "run backward";
  if (word == axis.stop) return "stop";
  if (word == axis.quick_stop) return "quick stop";
  if (word == axis.reset) return "fault reset";
  return word == axis.off ? "off" : "no known command";
}

}  // namespace takt
