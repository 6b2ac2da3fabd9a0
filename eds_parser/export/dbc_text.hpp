#pragma once
#include <set>
#include <string>
#include <string_view>

namespace takt {

/// Makes a C identifier. Characters that it may not have become `_`.
std::string dbc_name(std::string_view text);
/// Shortens `name` to at most 32 characters so that it is not yet in `used`, and adds it to `used`.
std::string shorten(const std::string& name, std::set<std::string>& used);
/// Converts UTF-8 to text for use within quotes: Windows-1252 without quotes.
std::string dbc_text(std::string_view utf8);

}  // namespace takt
