#include "eds_parser/export/dbc_text.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_name = 32;

bool is_word(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

std::string dbc_name(std::string_view text) {
  std::string name;
  for (const char c : text) name += is_word(c) ? c : '_';
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name.insert(0, 1, '_');
  return name;
}

std::string shorten(const std::string& name, std::set<std::string>& used) {
  auto candidate = name.substr(0, longest_name);
  for (unsigned n = 2; !used.insert(candidate).second; ++n) {
    const auto tail = '_' + std::to_string(n);
    candidate = name.substr(0, longest_name - tail.size()) + tail;
  }
  return candidate;
}

std::string dbc_text(std::string_view utf8) {
  std::string text;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    if (byte < 0x80) {
      text += byte == '"' || byte == '\\' || byte < 0x20 ? '\'' : utf8[i];
      continue;
    }
    const bool latin = (byte == 0xC2 || byte == 0xC3) && i + 1 < utf8.size();
    if (latin) {
      text +=
          static_cast<char>((byte & 0x03) << 6 | (static_cast<unsigned char>(utf8[i + 1]) & 0x3F));
    } else {
      text += '?';
    }
    while (i + 1 < utf8.size() && (static_cast<unsigned char>(utf8[i + 1]) & 0xC0) == 0x80) ++i;
  }
  return text;
}

}  // namespace takt
