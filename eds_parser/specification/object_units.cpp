#include "eds_parser/specification/object_units.hpp"

namespace takt {

std::optional<ObjectQuantity> quantity_of(ObjectKey object) noexcept {
  if (object.index < 0x6000 || object.index >= 0xA000) return {};
  switch (first_axis(object.index)) {
    case 0x6062:  // position demand
    case 0x6064:  // position actual
    case 0x607A:  // target position
    case 0x607B:  // position range limit
    case 0x607D:  // software position limit
    case 0x60BA:  // touch probe positions
    case 0x60BB:
    case 0x60BC:
    case 0x60BD:
    case 0x60C1:  // interpolation data record
    case 0x60FC:  // position demand internal
      return ObjectQuantity{Quantity::position, true, true};
    case 0x607C:  // home offset
    case 0x60B0:  // position offset
    case 0x60F4:  // following error
      return ObjectQuantity{Quantity::position, true, false};
    case 0x6065:  // following error window
    case 0x6067:  // position window
      return ObjectQuantity{Quantity::position, false, false};
    case 0x606B:  // velocity demand
    case 0x606C:  // velocity actual
    case 0x60B1:  // velocity offset
    case 0x60FF:  // target velocity
      return ObjectQuantity{Quantity::velocity, true, false};
    case 0x606D:  // velocity window
    case 0x606F:  // velocity threshold
    case 0x607F:  // max profile velocity
    case 0x6081:  // profile velocity
    case 0x6082:  // end velocity
    case 0x6099:  // homing speeds
    case 0x60F8:  // max slippage
      return ObjectQuantity{Quantity::velocity, false, false};
    case 0x6083:  // profile acceleration
    case 0x6084:  // profile deceleration
    case 0x6085:  // quick stop deceleration
    case 0x609A:  // homing acceleration
    case 0x60C5:  // max acceleration
    case 0x60C6:  // max deceleration
      return ObjectQuantity{Quantity::acceleration, false, false};
    case 0x6071:  // target torque
    case 0x6074:  // torque demand
    case 0x6077:  // torque actual
    case 0x60B2:  // torque offset
      return ObjectQuantity{Quantity::torque, true, false};
    case 0x6072:  // max torque
    case 0x60E0:  // positive torque limit
    case 0x60E1:  // negative torque limit
      return ObjectQuantity{Quantity::torque, false, false};
    default:
      return {};
  }
}

}  // namespace takt
