#pragma once
#include <set>
#include <string>
#include <string_view>

namespace takt {

/// A C identifier: what is none becomes `_`.
std::string dbc_name(std::string_view text);
/// `name` in at most 32 characters and not yet in `used`, which it joins.
std::string shorten(const std::string& name, std::set<std::string>& used);
/// Text within quotes: Windows-1252 without quotes, from UTF-8.
std::string dbc_text(std::string_view utf8);
/// The shortest text that reads back as the same number.
std::string dbc_number(double value);

}  // namespace takt
