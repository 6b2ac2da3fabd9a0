#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Learns when the last expected PDO usually arrives, so that one call of Intake::drain() at that
/// time takes all of them. The prediction is a high quantile of the arrival times, not their
/// maximum: the loop also waits for PDOs that come later than predicted, and a single late PDO must
/// not delay the images of the next cycles. Times count from SYNC and are limited to the receive
/// window.
class ArrivalPrediction {
 public:
  explicit ArrivalPrediction(Time window) noexcept : window_{window}, predicted_{window} {}

  Time predicted() const noexcept { return predicted_; }
  bool learned() const noexcept { return seen_ >= learning; }

  /// Notes that all expected PDOs had arrived at the first drain; the last one came at `arrival`.
  void in_time(Time arrival) noexcept {
    if (seen_ < learning) {
      latest_ = std::max(latest_, arrival);
      if (++seen_ == learning) predicted_ = std::min(window_, latest_ + margin);
      return;
    }
    predicted_ -= (predicted_ - std::min(predicted_, arrival + margin)) / slowness;
  }

  /// Notes that the last expected PDO came at `arrival`, after the first drain. The caller reports
  /// nothing if a PDO never came.
  void late(Time arrival) noexcept {
    const Time excess = std::max(Time{0}, arrival - predicted_) + margin;
    predicted_ = std::min(window_, predicted_ + std::min(excess, step));
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(predicted_, latest_, seen_);
  }

 private:
  static constexpr std::uint32_t learning = 16;  ///< cycles that wait for the whole window
  /// A late PDO affects the prediction for about this many cycles.
  static constexpr std::int64_t slowness = 256;
  static constexpr Time margin = std::chrono::microseconds{5};
  /// Largest increase for one late PDO.
  static constexpr Time step = std::chrono::microseconds{20};

  Time window_;
  Time predicted_;
  Time latest_{};
  std::uint32_t seen_ = 0;
};

}  // namespace takt
