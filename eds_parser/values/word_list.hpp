#pragma once
#include <string_view>

namespace takt {

/// Returns true if `word` is one of the words of a text, which are separated by one blank each.
constexpr bool has_word(std::string_view words, std::string_view word) noexcept {
  while (!words.empty()) {
    const auto end = words.find(' ');
    if (words.substr(0, end) == word) return true;
    words = end == words.npos ? std::string_view{} : words.substr(end + 1);
  }
  return false;
}

}  // namespace takt
