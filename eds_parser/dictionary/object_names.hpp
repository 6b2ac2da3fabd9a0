#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Converts a name: `Position actual value` becomes `position_actual_value`. The result is never
/// empty and has at most 61 characters.
std::string snake_case(std::string_view text);

/// Returns the name of an object for messages and signals: the name of the object itself for a VAR,
/// else the name of its sub-index.
std::string object_name(const ObjectDictionary& dictionary, ObjectKey key);

/// The names under which users and programs find the objects of a device.
///
/// A VAR has its name in snake_case, `position_actual_value`. The name of an entry of an ARRAY or
/// RECORD begins with that of the object: `identity_object.vendor_id`. The second part alone also
/// finds the entry if no other entry has this name. The objects of the second axis of a drive,
/// which are 0x800 higher, often have the same names as those of the first. In this case, `_2` is
/// appended to their names, and `_3` to those of the third axis.
class ObjectNames {
 public:
  struct Entry {
    ObjectKey key;
    std::string name;
  };

  explicit ObjectNames(const ObjectDictionary& dictionary);

  /// Returns all objects that hold a value, in ascending order. Names need not be unique, because
  /// device files repeat them.
  const std::vector<Entry>& entries() const noexcept { return entries_; }
  /// Returns the objects that a word stands for, in ascending order: one, several if the word is
  /// ambiguous or names a RECORD, or none. Case, blanks and punctuation do not count.
  std::vector<ObjectKey> find(std::string_view word) const;
  /// Returns the name of an object, or an empty text if the device file does not have it.
  std::string_view name_of(ObjectKey key) const noexcept;
  /// Returns up to five names that may be meant by a word that finds nothing.
  std::vector<std::string> similar(std::string_view word) const;

 private:
  using Index = std::multimap<std::string, ObjectKey, std::less<>>;

  std::vector<Entry> entries_;
  Index full_;     ///< names of entries_
  Index short_;    ///< names of entries of an ARRAY or RECORD, without that of the object
  Index records_;  ///< names of ARRAYs and RECORDs
};

}  // namespace takt
