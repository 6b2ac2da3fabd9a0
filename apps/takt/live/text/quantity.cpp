#include "apps/takt/live/text/quantity.hpp"

#include <cmath>
#include <fmt/format.h>

#include "apps/takt/live/text/line.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr int most_decimals = 4;

}  // namespace

std::string number_text(double value, std::size_t width, int decimals) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  for (int digits = decimals; digits >= 0; --digits) {
    const std::string text = fmt::format("{:.{}f}", value, digits);
    const bool looks_zero = value != 0.0 && std::abs(value) < 0.5 * std::pow(10.0, -digits);
    if (looks_zero) break;
    if (text.size() <= width) return text;
  }
  for (int digits = most_decimals; digits > 0; --digits) {
    const std::string text = fmt::format("{:.{}e}", value, digits);
    if (text.size() <= width) return text;
  }
  return fmt::format("{:.0e}", value);
}

std::string quantity_text(const ShownQuantity& quantity, std::size_t width,
                          std::size_t unit_width) {
  if (!quantity.value) return "-";
  const bool counts = quantity.unit.empty();
  const std::string number = number_text(*quantity.value, width, counts ? 0 : most_decimals);
  return number + ' ' + (counts ? "cnt" : shortened(printable_text(quantity.unit), unit_width));
}

}  // namespace takt
