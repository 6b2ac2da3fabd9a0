#pragma once
#include "eds_parser/integer_of.hpp"

namespace takt {

/// The objects by which a drive of CiA 402 is told what to do and tells what it does.
inline bool has_drive_words(const ObjectDictionary& dictionary) noexcept {
  return dictionary.find(ObjectKey{0x6040, 0}) != nullptr &&
         dictionary.find(ObjectKey{0x6041, 0}) != nullptr;
}

/// A file that gives 0x1000 no value, but has the words of a drive, is taken for that of a drive.
inline bool is_drive_by_objects(const ObjectDictionary& dictionary) noexcept {
  return !integer_of(dictionary, {0x1000, 0}) && has_drive_words(dictionary);
}

/// Number of the device profile (401, 402 ...): the low word of 0x1000; 0: none.
inline std::int64_t profile_of(const ObjectDictionary& dictionary) noexcept {
  if (is_drive_by_objects(dictionary)) return 402;
  return integer_of(dictionary, {0x1000, 0}).value_or(0) & 0xFFFF;
}

}  // namespace takt
