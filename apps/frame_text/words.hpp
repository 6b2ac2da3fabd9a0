#pragma once
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

namespace takt {

/// What blanks separate; of a long line the first 32.
std::vector<std::string_view> words_of(std::string_view text);

/// None: not a number as a whole, or too large for `T`.
template <class T>
std::optional<T> number_in(std::string_view text, int base) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
  return value;
}

}  // namespace takt
