#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/data_type.hpp"

namespace takt {

/// How one value of the image is to be read.
struct ValueFormat {
  DataType type = DataType::integer32;
  std::uint8_t bits = 32;
  double scale = 1.0;  ///< SI = raw * scale + offset
  double offset = 0.0;
};

/// Raw image values to SI and back, all at once.
class Units {
 public:
  Units() = default;
  explicit Units(std::span<const ValueFormat> formats);

  std::size_t size() const noexcept { return formats_.size(); }
  const ValueFormat& format(std::size_t signal) const noexcept { return formats_[signal]; }

  /// All values; `raw` and `si` have size() elements.
  void to_si(std::span<const std::int64_t> raw, Eigen::Ref<Eigen::ArrayXd> si) const;

  /// One value, rounded to the nearest raw value and held inside what its bits can carry. NaN
  /// gives the raw value of 0 SI.
  std::int64_t to_raw(std::size_t signal, double si) const;

  /// The same for a number from outside, not held inside anything: what the signal's bits can't
  /// carry stays too large for them. None: infinite, or more than 64 bits.
  std::optional<std::int64_t> raw_of(std::size_t signal, double si) const;

 private:
  std::vector<ValueFormat> formats_;
  Eigen::ArrayXd scale_;
  Eigen::ArrayXd offset_;
  std::vector<std::size_t> patterns_;  // signals whose int64_t is a bit pattern: REAL, unsigned 64
};

/// The number that an image value stands for, without scale.
double number_of(DataType type, std::int64_t raw) noexcept;

/// Smallest and largest raw value of `bits` bits.
struct RawRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};
RawRange raw_range(DataType type, unsigned bits) noexcept;

/// Whether `raw` can be sent as `bits` bits of `type` without loss.
bool fits(DataType type, unsigned bits, std::int64_t raw) noexcept;

}  // namespace takt
