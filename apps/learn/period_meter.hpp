#pragma once
#include <array>
#include <cstdint>
#include <optional>

namespace takt {

/// The usual time between frames of one kind: the median of the newest intervals. Memory is fixed.
class PeriodMeter {
 public:
  /// `us`: when it came; none where the recording has no times.
  void add(std::optional<std::int64_t> us) noexcept;
  /// Microseconds; none: fewer than three intervals.
  std::optional<std::int64_t> median() const;
  /// Of however few; none: there is no interval.
  std::optional<std::int64_t> shortest() const;
  /// The median where three of four intervals are within 2 % of it: somebody's timer.
  std::optional<std::int64_t> steady() const;
  std::uint64_t count() const noexcept { return count_; }

 private:
  std::optional<std::int64_t> last_;
  std::uint64_t count_ = 0;
  std::uint32_t used_ = 0;
  std::uint32_t next_ = 0;
  std::array<std::int64_t, 255> intervals_{};
};

/// A measured time as somebody would have written it: 1999.6 ms is 2000 ms. At most 0.25 % off, 1 %
/// where it becomes 1, 2, 2.5, 4, 5 or 8 times a power of ten: masters in software are that slow.
std::int64_t as_configured(std::int64_t measured) noexcept;

/// That of microseconds, in milliseconds; none: it is no time of an UNSIGNED16 but 0.
std::optional<std::int64_t> as_configured_ms(std::optional<std::int64_t> measured_us) noexcept;

}  // namespace takt
