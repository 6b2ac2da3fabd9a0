#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace takt {

/// A value with its unit.
struct ShownQuantity {
  std::optional<double> value;  ///< empty if the value is not known
  std::string unit;             ///< empty for raw counts
};

/// Returns a number with at most `decimals` digits behind the decimal point, in at most `width`
/// columns: with fewer digits or with an exponent if it is too long. A number that is not 0 never
/// looks like 0.
std::string number_text(double value, std::size_t width, int decimals);

/// Returns a number and its unit, for example "1.2500 rad" or "1250 cnt" for raw counts; "-" if it
/// is not known. The number takes at most `width` columns, and the unit at most `unit_width`.
std::string quantity_text(const ShownQuantity& quantity, std::size_t width,
                          std::size_t unit_width = 6);

}  // namespace takt
