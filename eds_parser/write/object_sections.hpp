#pragma once
#include <string>
#include <vector>

#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// An object as the lines of its sections, for objects that a file only implies (CompactPDO,
/// modules). Values are left out: [DefaultValue] stands as the file has it. CiA 306, 4.6.3.2.
std::vector<std::string> object_sections(const Object& object);

/// A value of `type` as CiA 306 writes it: reads back as the same.
std::string eds_value_text(const Value& value, DataType type);

}  // namespace takt
