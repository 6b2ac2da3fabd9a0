#pragma once
#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// Adds the PDOs that CompactPDO and NrOfRXPDO / NrOfTXPDO imply. CiA 306, 4.6.3.4.1.
void expand_compact_pdos(ObjectDictionary& dictionary);

}  // namespace takt
