#pragma once
#include <optional>

#include "eds_parser/network_spec.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// How an object of CiA 402 counts.
struct ObjectQuantity {
  Quantity quantity = Quantity::position;
  bool directed = true;   ///< `sign` turns it; false: a magnitude, such as a limit or a window
  bool absolute = false;  ///< `offset` shifts it; false: a difference
};

/// Quantity of a CiA 402 object, of any axis of a device (0x6000 + 0x800 n); none: not one of them.
std::optional<ObjectQuantity> quantity_of(ObjectKey object) noexcept;

/// The object of axis 1 (0x607A for 0x687A); other indices stay.
constexpr std::uint16_t first_axis(std::uint16_t index) noexcept {
  return index >= 0x6000 && index < 0xA000 ? static_cast<std::uint16_t>(0x6000 + index % 0x800)
                                           : index;
}

}  // namespace takt
