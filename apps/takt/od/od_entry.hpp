#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/objects/known_device.hpp"

namespace takt {

/// One object of a device, as `takt od` prints it.
struct OdEntry {
  ObjectKey key;
  std::string name;                 ///< name in the form of ObjectNames
  const Object* object = nullptr;   ///< object in the dictionary of the device
  const SubObject* sub = nullptr;   ///< sub-index of this object
  std::vector<std::string> pdos{};  ///< PDOs that carry the object: "TPDO1"
  /// Reason why the object is not read from a device; empty if it is read.
  std::string why_unread{};
  std::optional<std::vector<std::byte>> value{};
  std::string error{};  ///< reason why the device did not give the value

  /// Returns true if the object is an ARRAY or RECORD, and this is one of its entries.
  bool is_entry() const noexcept {
    return object->type == ObjectType::array || object->type == ObjectType::record;
  }
};

/// The objects that the user wants to see.
struct OdChoice {
  std::uint16_t first = 0;
  std::uint16_t last = 0xFFFF;
  std::string word;  ///< part of a name or of an index; empty means all
};

/// Reads `6000..6100`, `6041` or `0x6041` into a choice. Returns false if the text is no range.
bool read_range(std::string_view text, OdChoice& choice);

/// Returns the objects of a device that fit the choice, in ascending order. The entries refer to
/// `device`, whose dictionary must be known.
std::vector<OdEntry> od_entries(const KnownDevice& device, const OdChoice& choice);

/// Gives the entries the values of the device file: ParameterValue, else DefaultValue.
void take_file_values(std::vector<OdEntry>& entries);

/// Returns the name of a type as `takt sdo` takes it: u16, i32, f32, bool, string.
std::string type_word(const SubObject& sub);

}  // namespace takt
