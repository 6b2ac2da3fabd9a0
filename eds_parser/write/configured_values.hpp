#pragma once
#include <vector>

#include "eds_parser/dictionary/concise_dcf.hpp"
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// Returns the values that a DCF configures (each ParameterValue that may be written), in an order
/// in which a device accepts them. Objects are in ascending order, and the values of each PDO
/// follow each other: PDO invalid, mapping off, mapping, parameters, PDO valid. `report` gets the
/// values that are left out. CiA 302-3; CiA 301, 7.5.2.36.
std::vector<ConciseEntry> configured_values(const ObjectDictionary& dictionary, Report& report);

struct ConfiguredValues {
  std::vector<ConciseEntry> entries;  ///< empty if a finding is an error
  Findings findings;                  ///< including those of the file
};

/// Returns the values that a DCF configures. A file with an error configures nothing.
ConfiguredValues configured_values(const EdsFile& file);

}  // namespace takt
