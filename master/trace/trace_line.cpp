#include "master/trace/trace_line.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "eds_parser/values/number_in.hpp"
#include "master/trace/words.hpp"

namespace takt {
namespace {

using Words = std::span<const std::string_view>;

constexpr const char* unnamed_interface = "can0";  // name for a trace without names

bool is_direction(std::string_view word) { return word == "Rx" || word == "Tx"; }

/// Returns true if the word consists of digits with at most one dot.
bool is_time(std::string_view word) {
  return !word.empty() && std::ranges::count(word, '.') <= 1 &&
         std::ranges::all_of(word,
                             [](unsigned char c) { return c == '.' || std::isdigit(c) != 0; });
}

/// Converts the milliseconds of PCAN to seconds: `46268.2` becomes `46.268200`.
std::string seconds_of(std::string_view milliseconds) {
  const std::size_t dot = std::min(milliseconds.find('.'), milliseconds.size());
  const auto whole = number_in<std::uint64_t>(milliseconds.substr(0, dot), 10).value_or(0);
  std::string micros{milliseconds.substr(std::min(dot + 1, milliseconds.size()))};
  micros.resize(3, '0');
  return fmt::format("{}.{:03}{}", whole / 1000, whole % 1000, micros);
}

/// Returns the name of the interface for a channel. A line without a channel has another word in
/// its place.
std::string interface_of(std::string_view channel) {
  const bool is_channel = channel.size() <= 3 && number_in<std::uint8_t>(channel, 10);
  return is_channel ? fmt::format("can{}", channel) : unnamed_interface;
}

/// Reads a length, then the bytes or `RTR`. Further words are ignored.
bool read_payload(Words words, Frame& frame, int base = 16) {
  if (words.empty()) return false;
  const auto length = number_in<std::uint8_t>(words[0], 10);
  if (!length || *length > 8) return false;
  frame.length = *length;
  if (words.size() >= 2 && words[1] == "RTR") frame.rtr = true;
  if (frame.rtr) return true;
  if (words.size() < 1U + *length) return false;
  for (std::size_t i = 0; i < *length; ++i) {
    const auto byte = number_in<std::uint8_t>(words[1 + i], base);
    if (!byte || (base == 16 && words[1 + i].size() != 2)) return false;
    frame.data[i] = *byte;
  }
  return true;
}

/// Reads an identifier. Four digits are an 11-bit identifier, eight digits a 29-bit one.
bool read_padded_id(std::string_view text, Frame& frame) {
  const auto id = number_in<std::uint32_t>(text, 16);
  if (!id || (text.size() != 4 && text.size() != 8)) return false;
  if (*id > (text.size() == 8 ? 0x1FFF'FFFFU : 0x7FFU)) return false;
  frame.id = text.size() == 8 ? CobId::extended(*id) : CobId::base(*id);
  return true;
}

CandumpLine error_frame(std::string stamp, std::string_view channel) {
  CandumpLine line{.stamp = std::move(stamp), .interface = interface_of(channel)};
  line.error_frame = true;
  line.frame.id = CobId::extended(0);
  return line;
}

bool is_numbered(Words words) {
  return words.size() >= 4 && words[0].ends_with(')') && is_time(words[1]) &&
         number_in<std::uint64_t>(words[0].substr(0, words[0].size() - 1), 10);
}

/// Reads a line like `13)  45412.6  Tx  0601  8  40 ...`. Version 1.0 has no direction. Since
/// version 1.2 there is a channel before `Tx`, since version 1.3 a `-` before the length.
std::optional<CandumpLine> parse_pcan_1(Words words) {
  if (!is_numbered(words)) return {};
  if (words[2] == "Error") return error_frame(seconds_of(words[1]), {});
  if (words[3] == "Error") return error_frame(seconds_of(words[1]), words[2]);
  if (words.size() >= 5 && words[4] == "ERROR") return error_frame(seconds_of(words[1]), {});
  CandumpLine line{.stamp = seconds_of(words[1]), .interface = interface_of({})};
  words = words.subspan(2);
  if (words.size() >= 2 && words[0].size() <= 2 && is_direction(words[1])) {
    line.interface = interface_of(words[0]);
    words = words.subspan(1);
  }
  if (is_direction(words[0])) words = words.subspan(1);
  if (words.empty() || !read_padded_id(words[0], line.frame)) return {};
  words = words.subspan(1);
  if (!words.empty() && words[0] == "-") words = words.subspan(1);
  if (!read_payload(words, line.frame)) return {};
  return line;
}

/// Reads a line like `904  4023.599 DT  0601 Rx 8  40 ...`. Version 2.1 has a channel before the
/// identifier and a `-` before the length. `RR` is a remote frame, `ER` an error frame.
std::optional<CandumpLine> parse_pcan_2(Words words) {
  if (words.size() < 6 || !is_time(words[1])) return {};
  if (words[2] == "ER") return error_frame(seconds_of(words[1]), words[3]);
  if (words[2] != "DT" && words[2] != "RR") return {};
  CandumpLine line{.stamp = seconds_of(words[1]), .interface = interface_of({})};
  line.frame.rtr = words[2] == "RR";
  words = words.subspan(3);
  if (words[0].size() <= 2) {
    line.interface = interface_of(words[0]);
    words = words.subspan(1);
  }
  if (words.size() < 3 || !read_padded_id(words[0], line.frame) || !is_direction(words[1])) {
    return {};
  }
  words = words.subspan(2);
  if (words[0] == "-") words = words.subspan(1);
  if (!read_payload(words, line.frame)) return {};
  return line;
}

/// Reads a line like `1.001000 1  601  Tx  d 8 40 ...`. An `x` after the identifier marks 29 bits,
/// an `r` instead of `d` a remote frame. `1.001000 1  ErrorFrame` is an error frame, with or
/// without further words.
std::optional<CandumpLine> parse_vector(Words words, int base) {
  if (words.size() >= 3 && is_time(words[0]) && is_time(words[1]) && words[2] == "ErrorFrame") {
    return error_frame(std::string{words[0]}, words[1]);
  }
  if (words.size() < 5 || !is_time(words[0]) || !is_time(words[1])) return {};
  if (!is_direction(words[3]) || (words[4] != "d" && words[4] != "r")) return {};
  CandumpLine line{.stamp = std::string{words[0]}, .interface = interface_of(words[1])};
  std::string_view digits = words[2];
  const bool extended = digits.ends_with('x');
  if (extended) digits.remove_suffix(1);
  const auto id = number_in<std::uint32_t>(digits, base);
  if (!id || *id > (extended ? 0x1FFF'FFFFU : 0x7FFU)) return {};
  line.frame.id = extended ? CobId::extended(*id) : CobId::base(*id);
  line.frame.rtr = words[4] == "r";
  words = words.subspan(5);
  if (line.frame.rtr && words.empty()) return line;
  if (!read_payload(words, line.frame, base)) return {};
  return line;
}

/// Reads a line like `Timestamp: 1572.18 ID: 0601 S Rx DL: 8 40 ... Channel: can0`. The letter `X`
/// marks a 29-bit identifier, `R` a remote frame. Older versions write `DLC:` before the length.
std::optional<CandumpLine> parse_python_can(Words words) {
  if (words.size() < 7 || words[0] != "Timestamp:" || words[2] != "ID:") return {};
  CandumpLine line{.stamp = std::string{words[1]}, .interface = interface_of({})};
  const auto id = number_in<std::uint32_t>(words[3], 16);
  const Words rest = words.subspan(4);
  const auto length = std::ranges::find_if(
      rest, [](std::string_view word) { return word == "DL:" || word == "DLC:"; });
  if (!id || length == rest.end()) return {};
  const auto letters = rest.first(static_cast<std::size_t>(length - rest.begin()));
  const auto has = [&](std::string_view letter) {
    return std::ranges::find(letters, letter) != letters.end();
  };
  if (has("E") || has("F")) return {};  // error frame, CAN FD
  if (*id > (has("X") ? 0x1FFF'FFFFU : 0x7FFU)) return {};
  line.frame.id = has("X") ? CobId::extended(*id) : CobId::base(*id);
  line.frame.rtr = has("R");
  const auto name = std::ranges::find(words, std::string_view{"Channel:"});
  if (name != words.end() && name + 1 != words.end()) line.interface = *(name + 1);
  words = rest.subspan(letters.size() + 1);
  if (!read_payload(words, line.frame)) return {};
  return line;
}

/// Returns true for a line like `date Sat Sep 30 22:06:13.191 2017`, in any language.
bool is_date(Words words) {
  return words.size() >= 5 && words[0] == "date" && words.back().size() == 4 &&
         number_in<unsigned>(words.back(), 10);
}

/// Returns true for lines like `0.000000 Start of measurement`, `1.004000 1  Statistic: D 0 ...`,
/// `1.0 CAN 1 Status:chip ...` and `1.0 SV: 2 0 1 ::Env = 1`.
bool is_vector_event(Words words) {
  if (words.size() < 3 || !is_time(words[0])) return false;
  if (words[1] == "SV:" || words[2] == "Statistic:") return true;
  if (words[1] == "CAN") return words.size() >= 4 && words[3].starts_with("Status:");
  return words[1] == "Start" && words[2] == "of";
}

/// Returns true for lines on the state of the controller: `2)  1060.0  Warng  FFFFFFFF ...` and,
/// since version 2.0, `2  1060.0 ST ...` (state), `EC` (error counters) and `EV` (event of the
/// user).
bool is_pcan_state(Words words) {
  if (is_numbered(words)) {
    const auto begin = words.first(std::min<std::size_t>(words.size(), 5));
    const auto has = [&](std::string_view word) {
      return std::ranges::find(begin, word) != begin.end();
    };
    return has("Warng") || has("FFFFFFFF");
  }
  return words.size() >= 3 && number_in<std::uint64_t>(words[0], 10) && is_time(words[1]) &&
         (words[2] == "ST" || words[2] == "EC" || words[2] == "EV");
}

}  // namespace

std::optional<CandumpLine> parse_recorded(std::string_view text, int vector_base) {
  if (auto line = parse_candump(text)) return line;
  const std::vector<std::string_view> words = words_of(text);
  for (const auto parse : {parse_pcan_1, parse_pcan_2, parse_python_can}) {
    if (auto line = parse(words)) return line;
  }
  return parse_vector(words, vector_base);
}

std::optional<VectorHead> vector_head(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() < 2 || words[0] != "base") return {};
  if (words[1] != "dec" && words[1] != "hex") return {};
  const bool relative = words.size() >= 4 && words[2] == "timestamps" && words[3] == "relative";
  return VectorHead{.base = words[1] == "dec" ? 10 : 16, .relative = relative};
}

bool is_remark(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.empty() || words[0].starts_with(';') || words[0].starts_with("//")) return true;
  if (words[0] == "no") return words.size() >= 2 && words[1] == "internal";
  constexpr std::array heads{"base", "internal", "Begin", "End"};
  return std::ranges::find(heads, words[0]) != heads.end() || is_date(words) ||
         is_vector_event(words) || is_pcan_state(words);
}

}  // namespace takt
