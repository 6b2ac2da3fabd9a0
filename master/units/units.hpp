#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/values/raw_number.hpp"

namespace takt {

/// The data for the interpretation of one value of the image.
struct ValueFormat {
  DataType type = DataType::integer32;
  std::uint8_t bits = 32;
  double scale = 1.0;  ///< SI = raw * scale + offset
  double offset = 0.0;
};

/// Converts raw image values to SI units, all at once, and back.
class Units {
 public:
  Units() = default;
  explicit Units(std::span<const ValueFormat> formats);

  std::size_t size() const noexcept { return formats_.size(); }
  const ValueFormat& format(std::size_t signal) const noexcept { return formats_[signal]; }

  /// Converts all values; `raw` and `si` have size() elements.
  void to_si(std::span<const std::int64_t> raw, Eigen::Ref<Eigen::ArrayXd> si) const;

  /// Converts one value: rounds to the nearest raw value and limits it to the range of the signal's
  /// bits. NaN gives the raw value of 0 SI.
  std::int64_t to_raw(std::size_t signal, double si) const;

  /// Converts a number from outside without limiting it: a value too large for the signal's bits
  /// stays too large. Returns std::nullopt if the number is not finite or needs more than 64 bits.
  std::optional<std::int64_t> raw_of(std::size_t signal, double si) const;

 private:
  std::vector<ValueFormat> formats_;
  Eigen::ArrayXd scale_;
  Eigen::ArrayXd offset_;
  // Signals whose int64_t is a bit pattern: REAL and UNSIGNED64.
  std::vector<std::size_t> patterns_;
};

/// Smallest and largest raw value of `bits` bits.
struct RawRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};
RawRange raw_range(DataType type, unsigned bits) noexcept;

/// Returns true if `raw` can be sent as `bits` bits of `type` without loss.
bool fits(DataType type, unsigned bits, std::int64_t raw) noexcept;

}  // namespace takt
