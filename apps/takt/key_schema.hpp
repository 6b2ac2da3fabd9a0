#pragma once
#include <string>

namespace takt {

/// Returns the JSON schema (draft 7) of a network file as text, made from the tables of its keys.
/// Editors complete keys with it and show their meaning. It accepts each file that takt reads
/// without an error, and it finds unknown keys, wrong types, values out of range and missing keys.
/// It contains no rule that compares two keys, and nothing from EDS files.
std::string network_schema();

}  // namespace takt
