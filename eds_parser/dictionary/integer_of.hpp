#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Returns a value as an integer, or std::nullopt if there is no value or it is no integer.
inline std::optional<std::int64_t> integer_of(const std::optional<Value>& value) noexcept {
  return value ? as_integer(*value) : std::nullopt;
}

/// Returns the integer that the file gives to an object; see SubObject::value().
inline std::optional<std::int64_t> integer_of(const ObjectDictionary& dictionary,
                                              ObjectKey key) noexcept {
  const SubObject* sub = dictionary.find(key);
  return sub == nullptr ? std::nullopt : integer_of(sub->value());
}

/// Returns the integer that the file gives to an object, converted to an unsigned number.
inline std::optional<std::uint64_t> unsigned_of(const ObjectDictionary& dictionary,
                                                ObjectKey key) noexcept {
  return integer_of(dictionary, key);
}

/// Returns the value of an UNSIGNED32, or 0 if the file gives none.
inline std::uint32_t unsigned32_of(const ObjectDictionary& dictionary, ObjectKey key) noexcept {
  return static_cast<std::uint32_t>(integer_of(dictionary, key).value_or(0));
}

}  // namespace takt
