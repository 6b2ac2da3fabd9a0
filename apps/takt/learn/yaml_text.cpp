#include "apps/takt/learn/yaml_text.hpp"

#include <algorithm>
#include <cctype>

namespace takt::learn {

std::string yaml_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  }
  return out + '"';
}

std::string yaml_word(std::string_view text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const bool word = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
                    std::ranges::all_of(text, plain);
  return word ? std::string{text} : yaml_quoted(text);
}

}  // namespace takt::learn
