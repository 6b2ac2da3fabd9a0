#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"

namespace takt {

/// Returns whether plain_value() corrects the findings of this rule. It corrects all such findings
/// of an entry at once.
bool is_value_rule(std::string_view rule) noexcept;

/// Returns the value of an entry as CiA 306 writes it, without a comment. `rules` are the rules of
/// the findings on this entry. Reals become decimal, without the `f` of programming languages, and
/// octets become bare hex pairs. A correct value stays unchanged. Returns std::nullopt if the entry
/// has no valid value or if its type is not known.
std::optional<std::string> plain_value(const ObjectDictionary& dictionary,
                                       const IniSection& section, const IniEntry& entry,
                                       const std::set<std::string_view>& rules);

}  // namespace takt
