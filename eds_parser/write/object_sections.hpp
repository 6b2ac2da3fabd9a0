#pragma once
#include <string>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Returns the lines of an object's sections, for objects that a file only implies (CompactPDO,
/// modules). Parameter values are left out, and DefaultValue is written as in the file.
/// CiA 306, 4.6.3.2.
std::vector<std::string> object_sections(const Object& object);

}  // namespace takt
