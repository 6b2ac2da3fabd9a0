#include "master/gateway/ascii/ascii_words.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <utility>

namespace takt::ascii {
namespace {

/// Reads a word in quotes, in which `""` stands for one quote. `at` points behind the opening
/// quote.
Read<std::string> quoted_word(std::string_view line, std::size_t& at) {
  std::string text;
  while (at < line.size()) {
    const char c = line[at++];
    if (c != '"') {
      text += c;
    } else if (at < line.size() && line[at] == '"') {
      text += line[at++];
    } else {
      return text;
    }
  }
  return wrong("a quote is not closed");
}

}  // namespace

std::unexpected<Wrong> wrong(std::string why) {
  return std::unexpected{Wrong{AsciiError::syntax, std::move(why)}};
}

std::unexpected<Wrong> unsupported(std::string why) {
  return std::unexpected{Wrong{AsciiError::not_supported, std::move(why)}};
}

bool blank(char c) noexcept { return c == ' ' || c == '\t'; }

Read<std::vector<Word>> split(std::string_view line) {
  std::vector<Word> words;
  for (std::size_t at = 0; at < line.size();) {
    if (blank(line[at])) {
      ++at;
    } else if (line[at] == '#') {
      break;
    } else if (line[at] == '"') {
      auto text = quoted_word(line, ++at);
      if (!text) return std::unexpected{text.error()};
      words.push_back({std::move(*text), true});
    } else {
      const std::size_t from = at;
      while (at < line.size() && !blank(line[at]) && line[at] != '#') ++at;
      words.push_back({std::string{line.substr(from, at - from)}, false});
    }
  }
  return words;
}

Read<std::uint32_t> number(Words words, std::size_t at, std::uint32_t most, const char* what) {
  const auto value = at < words.size() ? parse_ascii_integer(words[at].text) : std::nullopt;
  if (!value) return wrong(fmt::format("expected {} (decimal, or 0x hex)", what));
  if (*value < 0 || *value > most) return wrong(fmt::format("{} is not in 0..{}", what, most));
  return static_cast<std::uint32_t>(*value);
}

bool is(const Word& word, std::string_view short_form, std::string_view full) {
  std::string text = word.text;
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return !word.quoted && (text == short_form || text == full);
}

Read<void> end_at(Words words, std::size_t count) {
  if (words.size() > count) return wrong("unexpected word '" + words[count].text + "'");
  return {};
}

}  // namespace takt::ascii
