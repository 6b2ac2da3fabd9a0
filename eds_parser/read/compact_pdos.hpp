#pragma once
#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Adds the PDOs that CompactPDO and NrOfRXPDO / NrOfTXPDO imply. In a DCF these PDOs are switched
/// off. CiA 306, 4.6.3.4.1 and 5.3.3.1.
void expand_compact_pdos(ObjectDictionary& dictionary);

}  // namespace takt
