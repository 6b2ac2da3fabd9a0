#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "eds_parser/ini.hpp"
#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// Of findings that one plain way to write the value of an entry mends, all at once.
bool is_value_rule(std::string_view rule) noexcept;

/// How CiA 306 writes what an entry has, without a comment. `rules`: what was found there. Reals
/// are decimal and without the `f` of a programming language, octets bare hex pairs; what is sound
/// stays as it is. None: it is no value, or its type is not known.
std::optional<std::string> plain_value(const ObjectDictionary& dictionary,
                                       const IniSection& section, const IniEntry& entry,
                                       const std::set<std::string_view>& rules);

}  // namespace takt
