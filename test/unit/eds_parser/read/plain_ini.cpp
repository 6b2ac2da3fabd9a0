#include "test/unit/eds_parser/read/plain_ini.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>

namespace takt::test {
namespace {

constexpr std::string_view blanks = " \t\x1A";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lower(std::string_view text) {
  std::string out{text};
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

/// Converts the whole text to a number. Returns std::nullopt if a part of the text does not belong
/// to the number.
template <class Number>
std::optional<Number> whole(std::string_view text, int base) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, base);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

std::optional<std::uint64_t> magnitude(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) {
    return whole<std::uint64_t>(text.substr(2), 16);
  }
  const bool octal = text.size() > 1 && text.front() == '0';
  return whole<std::uint64_t>(text, octal ? 8 : 10);
}

/// Reads a file. UTF-16 is supported as far as the characters are ASCII.
std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream in{path, std::ios::binary};
  std::string text{std::istreambuf_iterator<char>{in}, {}};
  for (const std::string_view mark : {"\xEF\xBB\xBF", "\xFF\xFE", "\xFE\xFF"}) {
    if (text.starts_with(mark)) text.erase(0, mark.size());
  }
  std::erase(text, '\0');
  return text;
}

}  // namespace

PlainIni read_plain_ini(const std::filesystem::path& path) {
  const std::string text = text_of_file(path);
  PlainIni ini;
  PlainSection left_out;
  PlainSection* section = &left_out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const auto line = trimmed(std::string_view{text}.substr(at, end - at));
    at = end + 1;
    if (line.empty() || line.front() == ';' || line.front() == '#') continue;
    if (line.front() == '[') {
      const auto [place, is_new] =
          ini.try_emplace(lower(trimmed(line.substr(1, line.find(']') - 1))));
      section = is_new ? &place->second : &left_out;
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    section->try_emplace(lower(trimmed(line.substr(0, equals))), trimmed(line.substr(equals + 1)));
  }
  return ini;
}

std::optional<PlainKey> plain_key(std::string_view section) {
  const auto index = whole<std::uint16_t>(section.substr(0, 4), 16);
  if (!index || section.size() < 4) return std::nullopt;
  if (section.size() == 4) return PlainKey{.index = *index, .sub = {}};
  if (section.substr(4, 3) != "sub") return std::nullopt;
  const auto sub = whole<std::uint8_t>(section.substr(7), 16);
  if (!sub) return std::nullopt;
  return PlainKey{.index = *index, .sub = sub};
}

std::optional<PlainNumber> plain_number(std::string_view text, unsigned node) {
  PlainNumber sum;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('+', at), text.size());
    auto term = trimmed(text.substr(at, end - at));
    at = end + 1;
    sum.negative = term.starts_with('-');
    if (sum.negative && at <= text.size()) return std::nullopt;
    if (sum.negative) term.remove_prefix(1);
    const auto number = lower(term) == "$nodeid" ? std::uint64_t{node} : magnitude(term);
    if (!number || (sum.negative && sum.bits != 0)) return std::nullopt;
    sum.bits += sum.negative ? ~*number + 1 : *number;
    sum.negative = sum.negative && sum.bits != 0;
  }
  return sum;
}

std::string_view text_of(const PlainSection& section, const std::string& key) {
  const auto found = section.find(key);
  return found == section.end() ? std::string_view{} : std::string_view{found->second};
}

}  // namespace takt::test
