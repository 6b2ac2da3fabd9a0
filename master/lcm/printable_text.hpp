#pragma once
#include <string>
#include <string_view>

namespace takt {

/// Makes text from outside safe for a terminal or a log, in one line: replaces control characters
/// (C0, DEL, C1), marks that change the writing direction, and bytes that are not UTF-8 by '?'.
std::string printable_text(std::string_view text);
/// Makes a text of several lines printable and keeps its line breaks.
std::string printable_lines(std::string_view text);

}  // namespace takt
