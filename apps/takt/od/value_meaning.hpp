#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "apps/takt/objects/known_device.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Returns the value of an object as a number, text or bytes, in the form in which people write it:
/// statuswords, identities and COB-IDs in hex, other numbers in decimal.
std::string shown_value(ObjectKey key, DataType type, std::span<const std::byte> bytes);

/// Returns what the value means, in words: the state of a drive, its mode, the parts of a COB-ID or
/// of a mapping entry, an error code. Returns the value in the unit of the network file for objects
/// with a quantity (CiA 402). The text is empty if the value has no further meaning.
std::string value_meaning(const KnownDevice& device, ObjectKey key, DataType type,
                          std::span<const std::byte> bytes);

/// A value in the unit of the network file.
struct UnitValue {
  double value = 0.0;
  std::string unit;
};

/// Returns std::nullopt if the network file gives the quantity of this object no unit.
std::optional<UnitValue> value_in_unit(const KnownDevice& device, ObjectKey key, DataType type,
                                       std::span<const std::byte> bytes);

}  // namespace takt
