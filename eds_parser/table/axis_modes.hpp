#pragma once
#include <cstdint>

#include "eds_parser/table/output_limits.hpp"

namespace takt {

/// Returns false if an axis in this mode of operation (0x6060) does not move to each set-point of
/// this quantity: another quantity controls the axis, or the set-point needs a handshake (profile
/// position). In manufacturer-specific modes, the axis counts as following the set-point. CiA
/// 402-2, 0x6060: 1 profile position, 2 velocity, 3 profile velocity, 4 profile torque, 6 homing, 7
/// interpolated position, 8 to 10 cyclic synchronous position, velocity and torque.
constexpr bool follows(AxisQuantity quantity, std::int64_t mode) noexcept {
  const auto number = static_cast<std::int8_t>(mode);
  switch (quantity) {
    case AxisQuantity::none:
      return true;
    case AxisQuantity::position:
      return number < 1 || number == 5 || number == 7 || number == 8 || number > 10;
    case AxisQuantity::velocity:
      return number < 1 || number == 3 || number == 5 || number == 9 || number > 10;
    case AxisQuantity::torque:
      return number < 1 || number == 4 || number == 5 || number > 9;
  }
  return true;
}

/// Returns true if a drive in this mode of operation reaches set-points of this quantity along its
/// own ramps (0x6083, 0x6084): the target velocity in profile velocity mode. A step of the
/// set-point is then no step of the axis.
constexpr bool has_ramps(AxisQuantity quantity, std::int64_t mode) noexcept {
  return quantity == AxisQuantity::velocity && static_cast<std::int8_t>(mode) == 3;
}

}  // namespace takt
