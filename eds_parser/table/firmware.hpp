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

/// A firmware version such as "15.02" or "16.00.00". Parts that are not given are 0.
struct Firmware {
  std::array<std::uint16_t, 3> parts{};

  constexpr auto operator<=>(const Firmware&) const noexcept = default;

  /// Returns std::nullopt unless `text` is one to three numbers of 0..65535 separated by dots.
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

  /// Finds the first version in a text such as "V16.00 build 7" (0x100A).
  static std::optional<Firmware> find_in(std::string_view text) noexcept {
    constexpr std::string_view digits = "0123456789";
    const std::size_t first = text.find_first_of(digits);
    if (first == text.npos) return {};
    text.remove_prefix(first);
    text = text.substr(0, text.find_first_not_of("0123456789."));
    for (;;) {
      if (const auto version = parse(text)) return version;
      const std::size_t dot = text.find_last_of('.');
      if (dot == text.npos) return {};
      text = text.substr(0, dot);
    }
  }
  /// Returns the version in 0x1018:03 of a device whose revision number is its firmware version.
  /// The upper half holds the main version.
  static constexpr Firmware of_revision(std::uint32_t revision) noexcept {
    return {{static_cast<std::uint16_t>(revision >> 16),
             static_cast<std::uint16_t>(revision & 0xFFFF), 0}};
  }

  /// Returns the version as one number with 16 bits for each part.
  constexpr std::int64_t packed() const noexcept {
    return std::int64_t{parts[0]} << 32 | std::int64_t{parts[1]} << 16 | parts[2];
  }
  static constexpr Firmware unpacked(std::int64_t number) noexcept {
    return {{static_cast<std::uint16_t>(number >> 32), static_cast<std::uint16_t>(number >> 16),
             static_cast<std::uint16_t>(number)}};
  }
};

/// Formats a version as "16.00.00".
inline std::string to_string(const Firmware& version) {
  std::string text;
  for (const std::uint16_t part : version.parts) {
    text += (text.empty() ? "" : part < 10 ? ".0" : ".") + std::to_string(part);
  }
  return text;
}

}  // namespace takt
