#pragma once
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

namespace takt {

/// Splits a text at its blanks. Returns at most the first 32 words.
std::vector<std::string_view> words_of(std::string_view text);

/// Reads a number to the given base. Returns std::nullopt if the whole text is not one number, or
/// if the number is too large for `T`.
template <class T>
std::optional<T> number_in(std::string_view text, int base) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
  return value;
}

}  // namespace takt
