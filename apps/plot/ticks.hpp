#pragma once
#include <string>
#include <vector>

namespace takt {

/// Round numbers along an axis of a picture.
struct Ticks {
  double step = 1.0;           ///< 1, 2 or 5 times a power of ten
  std::vector<double> values;  ///< multiples of `step`, at least two; they enclose the range

  double low() const { return values.front(); }
  double high() const { return values.back(); }
  /// Returns the number with the digits that `step` needs.
  std::string text(double value) const;
};

/// Returns ticks that enclose these finite values, with about `wanted` steps, at least 1. A range
/// of no width is widened.
Ticks enclosing_ticks(double low, double high, int wanted);

}  // namespace takt
