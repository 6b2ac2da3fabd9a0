#pragma once
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// Judges what a dictionary says: values against types and limits, PDOs against objects and
/// CAN identifiers, the objects that CiA 301 and the device's profile demand. What concerns the
/// text itself was already told by the reader. Findings are in order of their place in the file.
Findings check(const ObjectDictionary& dictionary);

}  // namespace takt
