#pragma once
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// Checks the content of a dictionary: values against types and limits, PDOs against objects and
/// CAN identifiers, and the objects that CiA 301 and the device profile demand. The reader has
/// already reported findings about the text itself. The findings are in the order of their place in
/// the file.
Findings check(const ObjectDictionary& dictionary);

}  // namespace takt
