#pragma once
#include <array>
#include <charconv>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace takt {

/// A firmware version as "15.02" or "16.00.00"; parts that are not given are 0.
struct Firmware {
  std::array<std::uint16_t, 3> parts{};

  constexpr auto operator<=>(const Firmware&) const noexcept = default;

  /// None: not one to three numbers of 0..65535 with dots between them.
  static std::optional<Firmware> parse(std::string_view text) noexcept {
    Firmware version;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (std::size_t part = 0; part < version.parts.size(); ++part) {
      const auto [next, error] = std::from_chars(at, end, version.parts[part]);
      if (error != std::errc{}) return {};
      if (next == end) return version;
      if (*next != '.') return {};
      at = next + 1;
    }
    return {};
  }
};

/// "16.00.00".
inline std::string to_string(const Firmware& version) {
  std::string text;
  for (const std::uint16_t part : version.parts) {
    text += (text.empty() ? "" : part < 10 ? ".0" : ".") + std::to_string(part);
  }
  return text;
}

}  // namespace takt
