#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// Returns the whole number nearest to `value`, or 10^18 with its sign if it is larger.
inline double nearest(double value) noexcept {
  const double within = std::clamp(value, -1e18, 1e18);
  return static_cast<double>(static_cast<std::int64_t>(within + std::copysign(0.5, within)));
}

/// The encoder on the shaft of the motor: it divides a turn into increments. The drive samples it
/// in each tick, and derives the speed from two samples by a filter of first order.
class ShaftEncoder {
 public:
  explicit ShaftEncoder(const MechanicsTable& table) noexcept
      : increment_{2 * std::numbers::pi / table.encoder.increments},
        per_radian_{1 / increment_},
        smoothing_{mechanics_tick / (mechanics_tick + table.controller.velocity_filter)},
        delay_{table.encoder.dead_time / mechanics_tick} {}

  void sample(double angle) noexcept {
    const double before = angle_;
    angle_ = quantised(angle);
    speed_ += smoothing_ * ((angle_ - before) * mechanics_ticks - speed_);
    if (std::abs(speed_) < slowest) speed_ = 0;
    newest_ = (newest_ + 1) % past_.size();
    past_[newest_] = angle;
  }
  /// Returns the angle and speed at the last sample: rad, rad/s.
  double angle() const noexcept { return angle_; }
  double speed() const noexcept { return speed_; }
  double increment() const noexcept { return increment_; }

  /// Returns the angle that the drive reports `later` seconds after the last sample. This angle is
  /// older by the dead time.
  double reported(double later, double speed) const noexcept {
    const double ago = delay_ - later / mechanics_tick;
    if (ago <= 0) return quantised(past_[newest_] - ago * speed * mechanics_tick);
    const auto whole = static_cast<std::size_t>(ago);
    const double part = ago - static_cast<double>(whole);
    return quantised(at(whole) + part * (at(whole + 1) - at(whole)));
  }

 private:
  static constexpr double slowest =
      1e-9;  // rad/s; below that, a filter would compute with denormals

  double quantised(double angle) const noexcept {
    return nearest(angle * per_radian_) * increment_;
  }
  double at(std::size_t samples_ago) const noexcept {
    return past_[(newest_ + past_.size() - samples_ago) % past_.size()];
  }

  double increment_;  ///< rad
  double per_radian_;
  double smoothing_;
  double delay_;  ///< ticks, below the size of past_ - 2
  double angle_ = 0;
  double speed_ = 0;
  std::array<double, 64> past_{};  ///< the last angles
  std::size_t newest_ = 0;
};

}  // namespace takt::sim
