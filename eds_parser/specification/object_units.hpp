#pragma once
#include <optional>

#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// The relation between the raw counts of a CiA 402 object and its quantity.
struct ObjectQuantity {
  Quantity quantity = Quantity::position;
  /// True if `sign` of the unit applies. False for a magnitude, such as a limit or a window.
  bool directed = true;
  /// True for a position to which `offset` of the unit applies. False for a distance, such as a
  /// window. For other quantities than positions, the offset always applies.
  bool absolute = false;
};

/// Returns the quantity of a CiA 402 object of any axis of a device (0x6000 + 0x800 n), or
/// std::nullopt if the object has none.
std::optional<ObjectQuantity> quantity_of(ObjectKey object) noexcept;

/// Returns the index of the same object for axis 1 (0x607A for 0x687A). Other indices are returned
/// unchanged.
constexpr std::uint16_t first_axis(std::uint16_t index) noexcept {
  return index >= 0x6000 && index < 0xA000 ? static_cast<std::uint16_t>(0x6000 + index % 0x800)
                                           : index;
}

}  // namespace takt
