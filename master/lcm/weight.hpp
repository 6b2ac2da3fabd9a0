#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace takt {

/// Severity of a message, with the codes of event_t.
enum class Weight : std::int16_t { note = 0, warning = 1, error = 2 };

/// Returns "note", "warning" or "error".
constexpr std::string_view name(Weight weight) noexcept {
  constexpr std::array<std::string_view, 3> names{"note", "warning", "error"};
  return names[static_cast<std::size_t>(weight)];
}

}  // namespace takt
