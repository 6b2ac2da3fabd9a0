#pragma once
#include <vector>

#include "eds_parser/concise_dcf.hpp"
#include "eds_parser/eds.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// What a DCF configures (each ParameterValue that may be written), in the order in which a device
/// takes it: ascending, and each PDO as one piece: invalid, mapping off, mapping, parameters,
/// valid. What is left out is told. CiA 302-3; CiA 301, 7.5.2.36.
std::vector<ConciseEntry> configured_values(const ObjectDictionary& dictionary, Report& report);

struct ConfiguredValues {
  std::vector<ConciseEntry> entries;  ///< empty where a finding is an error
  Findings findings;                  ///< those of the file too
};

/// The same of a file as it was read. One with an error configures nothing.
ConfiguredValues configured_values(const EdsFile& file);

}  // namespace takt
