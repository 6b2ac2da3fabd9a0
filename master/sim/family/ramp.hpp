#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// A speed that follows its set-point with a limited slope, in counts of the device.
class Ramp {
 public:
  explicit Ramp(std::int64_t counts_a_second) : slope_{counts_a_second} {}

  void reset(Time now) noexcept {
    value_ = target_ = rest_ = 0;
    last_ = now;
  }
  void aim(std::int64_t target) noexcept { target_ = target; }
  void drop() noexcept { value_ = target_ = 0; }

  /// Advances in whole steps of 1 ms; the remaining time waits for the next call.
  void advance(Time now) noexcept {
    const std::int64_t steps = (now - last_) / step;
    if (steps <= 0) return;
    last_ += steps * step;
    const std::int64_t thousandths = std::min<std::int64_t>(steps, 1'000'000) * slope_ + rest_;
    const std::int64_t reach = thousandths / 1000;
    value_ = std::clamp(target_, value_ - reach, value_ + reach);
    rest_ = value_ == target_ ? 0 : thousandths % 1000;
  }

  std::int64_t value() const noexcept { return value_; }
  Time next_change() const noexcept { return value_ == target_ ? never : last_ + step; }

 private:
  static constexpr Time step = std::chrono::milliseconds{1};

  std::int64_t slope_;
  std::int64_t value_ = 0;
  std::int64_t target_ = 0;
  std::int64_t rest_ = 0;  ///< thousandths of a count that the next step adds
  Time last_{};
};

}  // namespace takt::sim
