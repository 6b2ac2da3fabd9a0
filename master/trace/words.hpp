#pragma once
#include <string_view>
#include <vector>

namespace takt {

/// Splits a text at its blanks. Returns at most the first 32 words.
std::vector<std::string_view> words_of(std::string_view text);

}  // namespace takt
