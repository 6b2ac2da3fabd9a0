#include "eds_parser/network_file/yaml/map_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <utility>

#include "eds_parser/report/suggest.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_quote = 60;

std::string quote(std::string_view text) {
  std::string out = "`";
  for (const char c : text.substr(0, longest_quote)) {
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + (text.size() > longest_quote ? "...`" : "`");
}

bool is_scalar(const YamlNode& node, std::string_view key, std::string_view expected,
               NetworkReport& report) {
  if (node.kind == YamlNode::Kind::scalar) return true;
  report.error(node.pos, "wrong-type", "`", key, "` has to be ", expected, ", but this is ",
               node.kind == YamlNode::Kind::null ? "empty" : std::string{name(node.kind)});
  return false;
}

bool looks_octal(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_hex_without_prefix(std::string_view text) {
  const auto is = [](auto of) { return [of](unsigned char c) { return of(c) != 0; }; };
  return text.size() <= 4 && std::ranges::all_of(text, is(::isxdigit)) &&
         std::ranges::any_of(text, is(::isdigit)) && std::ranges::any_of(text, is(::isalpha));
}

/// Reads a decimal number or one with 0x, with an optional sign, and nothing else.
std::optional<std::int64_t> parse_integer(std::string_view text) {
  bool negative = false;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    negative = text[0] == '-';
    text.remove_prefix(1);
  }
  const bool is_hex = text.starts_with("0x") || text.starts_with("0X");
  if (is_hex) text.remove_prefix(2);
  const auto magnitude = number_in<std::uint64_t>(text, is_hex ? 16 : 10);
  constexpr std::uint64_t limit = std::uint64_t{1} << 63;
  if (!magnitude || *magnitude > limit || (*magnitude == limit && !negative)) return {};
  return static_cast<std::int64_t>(negative ? std::uint64_t{0} - *magnitude : *magnitude);
}

}  // namespace

std::string to_string(IntegerRange range) {
  // Indices, identifiers and flags are hexadecimal.
  const bool bits = range.low >= 0 && range.high >= 0x7FF && range.high <= 0xFFFF'FFFF &&
                    std::has_single_bit(static_cast<std::uint64_t>(range.high) + 1);
  const bool is_hex = range.unit.empty() && (range.low >= 0x180 || bits);
  const auto text = [&](std::int64_t number) {
    return is_hex && number != 0
               ? hex(static_cast<std::uint32_t>(number), range.high > 0xFFF ? 4 : 3)
               : std::to_string(number);
  };
  const std::string limits = text(range.low) + ".." + text(range.high);
  return range.unit.empty() ? limits : limits + ' ' + std::string{range.unit};
}

std::optional<std::int64_t> read_integer(const YamlNode& node, std::string_view key,
                                         IntegerRange range, NetworkReport& report) {
  if (!is_scalar(node, key, "a number", report)) return {};
  if (looks_octal(node.text)) {
    report.error(node.pos, "octal", quote(node.text), " of `", key,
                 "` is octal to some YAML readers and decimal to others: write it without leading "
                 "zeros, or with 0x");
    return {};
  }
  const auto value = parse_integer(node.text);
  if (!value) {
    report.error(node.pos, "not-a-number", "`", key, "`: ", quote(node.text),
                 is_hex_without_prefix(node.text)
                     ? " is hexadecimal without 0x: write 0x" + node.text
                     : " is not a whole number; expected " + to_string(range) + ", decimal or 0x");
    return {};
  }
  if (*value < range.low || *value > range.high) {
    report.error(node.pos, "out-of-range", "`", key, "`: ", quote(node.text), " is outside ",
                 range);
    return {};
  }
  return value;
}

std::optional<double> read_number(const YamlNode& node, std::string_view key,
                                  NetworkReport& report) {
  if (!is_scalar(node, key, "a number", report)) return {};
  if (const auto integer = parse_integer(node.text); integer && !looks_octal(node.text)) {
    return static_cast<double>(*integer);
  }
  std::string_view text = node.text;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto value = number_in<double>(text);
  if (!value || !std::isfinite(*value) || looks_octal(text)) {
    report.error(node.pos, "not-a-number", "`", key, "`: ", quote(node.text), " is not a number");
    return {};
  }
  return value;
}

std::optional<bool> read_bool(const YamlNode& node, std::string_view key, NetworkReport& report) {
  constexpr std::array<std::string_view, 4> yes{"true", "yes", "on", "1"};
  constexpr std::array<std::string_view, 4> no{"false", "no", "off", "0"};
  if (!is_scalar(node, key, "true or false", report)) return {};
  const auto is = [&](std::string_view word) { return same_word(node.text, word); };
  if (std::ranges::any_of(yes, is)) return true;
  if (std::ranges::none_of(no, is)) {
    report.error(node.pos, "wrong-type", "`", key, "` has to be true or false, not ",
                 quote(node.text));
    return {};
  }
  if (node.quoted) {
    report.warning(node.pos, "quoted", "`", key, "`: ", quote(node.text),
                   " in quotes is read as false; generators of other masters read any text as "
                   "true: write the word without quotes");
  }
  return false;
}

std::optional<std::string> read_text(const YamlNode& node, std::string_view key,
                                     NetworkReport& report) {
  if (!is_scalar(node, key, "text", report)) return {};
  if (node.text.empty()) {
    report.error(node.pos, "wrong-type", "`", key, "` is empty");
    return {};
  }
  return node.text;
}

std::optional<std::int64_t> read_number_key(const YamlPair& pair, std::string_view key,
                                            IntegerRange range, NetworkReport& report) {
  const YamlNode number{.kind = YamlNode::Kind::scalar, .text = pair.key, .pos = pair.key_pos};
  return read_integer(number, key, range, report);
}

MapReader::MapReader(const YamlNode& node, std::string what, NetworkReport& report)
    : node_{node}, what_{std::move(what)}, report_{report} {
  if (is_readable()) return;
  report.error(node.pos, "wrong-type", what_, " has to be a map (`key: value`), but this is ",
               name(node.kind));
}

const YamlNode* MapReader::take(std::string_view key) {
  known_.push_back(key);
  return node_.find(key);
}

SourcePos MapReader::key_pos(std::string_view key) const noexcept {
  const auto found = std::ranges::find(node_.pairs, key, &YamlPair::key);
  return found == node_.pairs.end() ? node_.pos : found->key_pos;
}

bool MapReader::has_slip_of(std::string_view key) const {
  return std::ranges::any_of(node_.pairs, [&](const YamlPair& pair) {
    const bool known = std::ranges::find(known_, pair.key) != known_.end();
    return !known && nearest(pair.key, known_) == key;
  });
}

void MapReader::ignore(std::string_view keys, std::string_view why) {
  while (!keys.empty()) {
    const std::string_view key = keys.substr(0, keys.find(' '));
    keys.remove_prefix(std::min(key.size() + 1, keys.size()));
    if (!has(key)) continue;
    known_.push_back(key);
    report_.note(key_pos(key), "unused-key", "`", key, "` of ", what_, " has no effect: ", why);
  }
}

void MapReader::finish() { finish_shared({}); }

void MapReader::finish_shared(std::string_view why) {
  for (const YamlPair& pair : node_.pairs) {
    if (std::ranges::find(known_, pair.key) != known_.end()) continue;
    const std::string guess = did_you_mean(pair.key, known_);
    const std::string text = "unknown key " + quote(pair.key) + " in " + what_;
    if (why.empty() || !guess.empty()) {
      report_.error(pair.key_pos, "unknown-key", text, guess);
    } else {
      report_.warning(pair.key_pos, "unknown-key", text, why);
    }
  }
}

std::optional<std::size_t> read_choice(const YamlNode& node, std::string_view key,
                                       std::span<const std::string_view> names,
                                       NetworkReport& report) {
  if (!is_scalar(node, key, "a word", report)) return {};
  const auto found = std::ranges::find(names, node.text);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string list;
  for (const std::string_view choice : names) {
    list += (list.empty() ? "" : ", ") + std::string{choice};
  }
  report.error(node.pos, "unknown-value", "`", key, "`: ", quote(node.text), " is not one of ",
               list, did_you_mean(node.text, names));
  return {};
}

}  // namespace takt
