#pragma once
#include <numbers>

#include "test/unit/master/sim/model/drive_fixture.hpp"

namespace takt::sim {

/// Makes a drive with the objects that act on a servo with mechanics.
inline SampleDevice servo_drive(NodeId node) {
  using enum DataType;
  SampleDevice device = drive(node);
  device.object(0x6063, 0, integer32, Access::ro, 0)
      .object(0x6072, 0, unsigned16, Access::rw, 3000)
      .object(0x6073, 0, unsigned16, Access::rw, 3000)
      .object(0x6074, 0, integer16, Access::ro, 0)
      .object(0x6078, 0, integer16, Access::ro, 0)
      .object(0x6087, 0, unsigned32, Access::rw, 0)
      .object(0x60B1, 0, integer32, Access::rw, 0)
      .object(0x60B2, 0, integer16, Access::rw, 0)
      .object(0x60C5, 0, unsigned32, Access::rw, 0)
      .object(0x60E0, 0, unsigned16, Access::rw, 3000)
      .object(0x60E1, 0, unsigned16, Access::rw, 3000);
  return device;
}

inline constexpr double counts_a_turn = 10'000;

/// The default servo, with 10,000 counts a turn.
inline MechanicsTable servo_mechanics() {
  MechanicsTable table;
  table.turn = counts_a_turn;
  return table;
}

class ServoDrive : public Drive {
 protected:
  explicit ServoDrive(const MechanicsTable& mechanics = servo_mechanics())
      : Drive{servo_drive(5_node), &mechanics} {}

  /// Returns the acceleration of the axis with this torque, in counts/s2.
  static double acceleration(double torque) {
    const MechanicsTable table;
    return torque / (table.motor.inertia + table.load.inertia) / (2 * std::numbers::pi) *
           counts_a_turn;
  }
};

}  // namespace takt::sim
