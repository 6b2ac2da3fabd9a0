#pragma once
#include <string>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Returns the name of an object type, for example `VAR` or `RECORD`.
std::string_view object_type_name(ObjectType type) noexcept;
/// Returns the list of an object: `mandatory`, `optional` or `manufacturer`. For an unlisted object
/// this is the list to which it belongs.
std::string_view list_name(const Object& object) noexcept;
/// Returns a time in microseconds.
constexpr double us(Time time) noexcept { return static_cast<double>(time.count()) / 1000; }
/// Formats bytes as hex pairs without prefix, for example `01a105`.
std::string hex_bytes(std::string_view bytes);
/// Returns a PDO's transmission type in words, for example `SYNC 1` or `every 3rd SYNC`. CiA 301,
/// tables 69 and 72.
std::string transmission_name(std::uint8_t type, bool is_tpdo);

}  // namespace takt
