#pragma once
#include <algorithm>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// A holding brake on the shaft of the motor. The brake is closed without current, and it opens and
/// closes slowly.
class Brake {
 public:
  explicit Brake(const BrakeParameters& table) noexcept
      : torque_{table.torque},
        opening_step_{step_of(table.opening)},
        closing_step_{step_of(table.closing)} {}

  /// Advances by one tick with or without current.
  void advance(bool current) noexcept {
    const double end = current ? 1 : 0;
    if (opened_ == end) return;
    opened_ = std::clamp(opened_ + (current ? opening_step_ : -closing_step_), 0.0, 1.0);
    // The faces separate at the end of the opening, and touch at the end of the closing.
    if (opened_ == end) is_closed_ = !current;
  }
  bool exists() const noexcept { return torque_ > 0; }
  bool is_closed() const noexcept { return exists() && is_closed_; }
  /// Returns the torque that the brake can hold now, in N m.
  double torque() const noexcept { return is_closed_ ? torque_ : 0; }

 private:
  /// Returns the part of the way in one tick if the whole way takes `time` (s).
  static double step_of(double time) noexcept {
    return time > mechanics_tick ? mechanics_tick / time : 1;
  }

  double torque_;  ///< N m
  double opening_step_;
  double closing_step_;
  double opened_ = 0;  ///< 0 .. 1
  bool is_closed_ = true;
};

}  // namespace takt::sim
