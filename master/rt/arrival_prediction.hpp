#pragma once
#include <algorithm>
#include <cstdint>

#include "eds_parser/table/time.hpp"

namespace takt {

/// Learns when the last expected PDO is usually there, so that one drain at that time finds them
/// all. A PDO that comes later is waited for, so a single one must not make the images of the next
/// cycles late: the prediction is a high quantile of the arrivals and not the latest of them. Times
/// count from SYNC. Bounded by the receive window.
class ArrivalPrediction {
 public:
  explicit ArrivalPrediction(Time window) noexcept : window_{window}, predicted_{window} {}

  Time predicted() const noexcept { return predicted_; }
  bool learned() const noexcept { return seen_ >= learning; }

  /// All expected PDOs were there at the first drain; the last one came at `arrival`.
  void in_time(Time arrival) noexcept {
    if (seen_ < learning) {
      latest_ = std::max(latest_, arrival);
      if (++seen_ == learning) predicted_ = std::min(window_, latest_ + margin);
      return;
    }
    predicted_ -= (predicted_ - std::min(predicted_, arrival + margin)) / slowness;
  }

  /// The last one came at `arrival`, after the first drain; where it stayed away nothing is
  /// learned.
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
  static constexpr std::int64_t slowness = 256;  ///< cycles that a late PDO is remembered
  static constexpr Time margin = std::chrono::microseconds{5};
  static constexpr Time step = std::chrono::microseconds{20};  ///< at most, for a late PDO

  Time window_;
  Time predicted_;
  Time latest_{};
  std::uint32_t seen_ = 0;
};

}  // namespace takt
