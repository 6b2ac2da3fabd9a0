#pragma once
#include "eds_parser/dictionary/integer_of.hpp"

namespace takt {

/// Returns true if the dictionary has the controlword and the statusword of a CiA 402 drive.
inline bool has_drive_words(const ObjectDictionary& dictionary) noexcept {
  return dictionary.find(ObjectKey{0x6040, 0}) != nullptr &&
         dictionary.find(ObjectKey{0x6041, 0}) != nullptr;
}

/// Returns true if the file gives 0x1000 no value, but has the controlword and the statusword. takt
/// treats such a device as a drive.
inline bool is_drive_by_objects(const ObjectDictionary& dictionary) noexcept {
  return !integer_of(dictionary, {0x1000, 0}) && has_drive_words(dictionary);
}

/// Returns the number of the device profile (401, 402 ...): the low word of 0x1000. 0 means no
/// profile.
inline std::int64_t profile_of(const ObjectDictionary& dictionary) noexcept {
  if (is_drive_by_objects(dictionary)) return 402;
  return integer_of(dictionary, {0x1000, 0}).value_or(0) & 0xFFFF;
}

}  // namespace takt
