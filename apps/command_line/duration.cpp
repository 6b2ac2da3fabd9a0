#include "apps/command_line/duration.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace takt {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 8> units{{{"", 1e9},
                                                                    {"ns", 1.0},
                                                                    {"us", 1e3},
                                                                    {"ms", 1e6},
                                                                    {"s", 1e9},
                                                                    {"min", 60e9},
                                                                    {"m", 60e9},
                                                                    {"h", 3600e9}}};
constexpr double longest = 1e18;

}  // namespace

std::optional<Time> parse_duration(std::string_view text) noexcept {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || number < 0) return std::nullopt;
  const std::string_view unit{rest, static_cast<std::size_t>(end - rest)};
  for (const auto& [name, factor] : units) {
    if (unit != name) continue;
    const double time = number * factor;
    if (!(time <= longest)) return std::nullopt;
    return Time{std::llround(time)};
  }
  return std::nullopt;
}

std::string duration_error(const std::string& text) {
  return parse_duration(text) ? "" : "'" + text + "' is not a time like 10s, 500ms or 2h";
}

}  // namespace takt
