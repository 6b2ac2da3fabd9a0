#pragma once
#include <string>
#include <string_view>

namespace takt::learn {

/// Returns the text in quotes, `"text"`. Control characters become `?`.
std::string yaml_quoted(std::string_view text);

/// Returns the text without quotes if YAML can only read it as a string, and in quotes otherwise.
std::string yaml_word(std::string_view text);

}  // namespace takt::learn
