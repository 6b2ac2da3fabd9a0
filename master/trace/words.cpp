#include "master/trace/words.hpp"

#include <algorithm>

namespace takt {

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  constexpr std::size_t most_words = 32;
  std::vector<std::string_view> words;
  while (words.size() < most_words) {
    const std::size_t begin = text.find_first_not_of(blank);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(blank, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
  return words;
}

}  // namespace takt
