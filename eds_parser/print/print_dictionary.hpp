#pragma once
#include <iosfwd>
#include <ostream>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// Prints one JSON document: device, all objects, PDOs, findings (`takt eds show --json`). It is
/// written object by object, so that a large dictionary does not need much memory.
void print_json(std::ostream& out, const ObjectDictionary& dictionary, const Findings& findings);

/// Prints the dictionary for the user: device, PDO tables, objects.
void print_text(std::ostream& out, const ObjectDictionary& dictionary);

}  // namespace takt
