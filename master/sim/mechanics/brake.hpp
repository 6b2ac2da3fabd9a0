#pragma once
#include <algorithm>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// A holding brake on the shaft of the motor: closed without current, and slow.
class Brake {
 public:
  explicit Brake(const BrakeParameters& table) noexcept : table_{table} {}

  /// Advances by one tick with or without current.
  void advance(bool current) noexcept {
    const double time = current ? table_.opening : table_.closing;
    const double step = time > mechanics_tick ? mechanics_tick / time : 1;
    opened_ = std::clamp(opened_ + (current ? step : -step), 0.0, 1.0);
    // The faces part at the end of the opening and touch at the end of the closing.
    if (opened_ == 1) is_closed_ = false;
    if (opened_ == 0) is_closed_ = true;
  }
  bool exists() const noexcept { return table_.torque > 0; }
  bool is_closed() const noexcept { return exists() && is_closed_; }
  /// Torque that it can hold now, in N m.
  double torque() const noexcept { return is_closed_ ? table_.torque : 0; }

 private:
  BrakeParameters table_;
  double opened_ = 0;  ///< 0 .. 1
  bool is_closed_ = true;
};

}  // namespace takt::sim
