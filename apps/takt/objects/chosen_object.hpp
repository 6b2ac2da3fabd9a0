#pragma once
#include <string>
#include <string_view>

#include "apps/takt/objects/known_device.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// The object that the user named.
struct ChosenObject {
  ObjectKey key;
  DataType type = DataType::unknown;  ///< unknown if nothing describes the object
  std::string name{};                 ///< empty if the user gave the index

  /// Returns `6041:00`, or `statusword (6041:00)`.
  std::string text() const;
};

/// Returns true if a word of the command line may be the name of an object: `statusword`,
/// `identity_object.vendor_id`. Returns false for numbers such as `6041` and `1018:1`.
bool is_object_name(std::string_view word) noexcept;

/// Finds an object of a device by the name of its signal, or by its name in the device file. Throws
/// a Failure that lists the candidates if the name is ambiguous, or similar names if it is unknown.
ChosenObject find_object(const KnownDevice& device, const std::string& word);

/// Returns the type of an object, or DataType::unknown if nothing describes it.
DataType type_of(const KnownDevice& device, ObjectKey key) noexcept;

}  // namespace takt
