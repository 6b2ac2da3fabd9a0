#pragma once
#include <array>
#include <cstdint>
#include <optional>

namespace takt::learn {

/// Measures the usual time between frames of one kind: the median of the newest 255 intervals. Its
/// memory is fixed.
class PeriodMeter {
 public:
  /// Adds a frame. `us` is its time in microseconds, or std::nullopt if the recording has no times.
  void add(std::optional<std::int64_t> us) noexcept;
  /// Returns the median interval in microseconds, or std::nullopt if there are fewer than three
  /// intervals.
  std::optional<std::int64_t> median() const;
  /// Returns the shortest interval in microseconds, or std::nullopt if there is no interval.
  std::optional<std::int64_t> shortest() const;
  /// Returns the median if at least three quarters of the intervals are within 2 % of it, as the
  /// frames of a timer are. Returns std::nullopt otherwise.
  std::optional<std::int64_t> steady() const;
  /// Returns the number of frames.
  std::uint64_t count() const noexcept { return count_; }

 private:
  std::optional<std::int64_t> last_;
  std::uint64_t count_ = 0;
  std::uint32_t used_ = 0;
  std::uint32_t next_ = 0;
  std::array<std::int64_t, 255> intervals_{};
};

/// Rounds a measured time to the value that a person has probably configured: 1999.6 ms becomes
/// 2000 ms. The result differs by at most 0.25 %, or by 1 % if it is 1, 2, 2.5, 4, 5 or 8 times a
/// power of ten, because masters in software are that inaccurate. Microseconds.
std::int64_t as_configured(std::int64_t measured) noexcept;

/// Returns as_configured() in milliseconds. Returns std::nullopt if there is no measured time, or
/// if the result is not in the range 1..65535 of an UNSIGNED16 time.
std::optional<std::int64_t> as_configured_ms(std::optional<std::int64_t> measured_us) noexcept;

}  // namespace takt::learn
