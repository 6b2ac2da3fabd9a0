#pragma once
#include <cstddef>
#include <string_view>

namespace takt {

/// Returns true if `Value` is a named enumerator: compilers print other values as a cast,
/// "(Kind)7".
template <auto Value>
consteval bool is_enumerator() noexcept {
  const std::string_view text{__PRETTY_FUNCTION__};
  const char next = text[text.rfind(')') + 1];
  return next < '0' || next > '9';
}

/// Returns the name of an enumerator, or `other` for a value without an enumerator. `names` has the
/// name of every enumerator, in the order of their values, which count from 0.
template <class Enum, std::size_t Count>
constexpr std::string_view name_of(Enum value, const std::string_view (&names)[Count],
                                   std::string_view other = {}) noexcept {
  static_assert(is_enumerator<static_cast<Enum>(Count - 1)>(), "there are too many names");
  static_assert(!is_enumerator<static_cast<Enum>(Count)>(), "an enumerator has no name");
  const auto index = static_cast<std::size_t>(value);
  return index < Count ? names[index] : other;
}

}  // namespace takt
