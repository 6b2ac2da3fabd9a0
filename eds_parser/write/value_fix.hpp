#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/ini.hpp"
#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// A number as CiA 306 writes it, of what parse_number() takes; none: it is none, or it can't be
/// written so that it reads as the same. Hexadecimal stays hexadecimal.
std::optional<std::string> plain_number(std::string_view text);

/// `1` for `true`; none: no such word.
std::optional<std::string> plain_flag(std::string_view text);

/// Text of a value that the dictionary has for a key (`DefaultValue`, `LowLimit` ...) of the
/// section of an object: reals in decimal, octets as bare hex pairs, unsigned numbers in
/// hexadecimal.
std::optional<std::string> value_as_read(const ObjectDictionary& dictionary,
                                         const IniSection& section, std::string_view key);

}  // namespace takt
