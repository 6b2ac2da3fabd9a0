#pragma once
#include <charconv>
#include <optional>
#include <string_view>

namespace takt {

/// Reads a number. `base` is the base of a whole number, 10 by default; a real number takes none.
/// Returns std::nullopt if the whole text is not one number, or if the number is too large for `T`.
template <class T, class... Base>
std::optional<T> number_in(std::string_view text, Base... base) noexcept {
  T value{};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, base...);
  return error == std::errc{} && end == last ? std::optional{value} : std::nullopt;
}

}  // namespace takt
