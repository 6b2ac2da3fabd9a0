#pragma once
#include <string>
#include <string_view>

namespace takt {

/// `"text"`; control characters become `?`.
std::string yaml_quoted(std::string_view text);

/// A word as it is where YAML can't take it for anything else, otherwise quoted.
std::string yaml_word(std::string_view text);

}  // namespace takt
