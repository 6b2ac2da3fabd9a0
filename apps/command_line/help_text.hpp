#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// Returns the width of the terminal at stdout, in columns from 40 to 100. Without a terminal, the
/// environment variable COLUMNS states the width, and the default is 80.
std::size_t text_width();

/// Breaks a text at its spaces into lines of at most `width` columns. A longer word is broken
/// anywhere.
std::vector<std::string> broken(std::string_view text, std::size_t width);

/// Returns a help text, broken into lines of at most `width` columns where words allow it. Options
/// have their names in the first `column` columns of `options`; `notes` are paragraphs, and
/// indented examples, whose lines are not joined.
std::string wrapped_help(std::string_view options, std::size_t column, std::string_view notes,
                         std::size_t width);

}  // namespace takt
