#pragma once
#include <string>
#include <string_view>

namespace takt {

/// Text from outside as a terminal or a log may show it, in one line: control characters (C0, DEL,
/// C1), marks that turn the direction of writing, and bytes that are no UTF-8 become '?'.
std::string printable_text(std::string_view text);
/// Makes a text of several lines printable; its line breaks are kept.
std::string printable_lines(std::string_view text);

}  // namespace takt
