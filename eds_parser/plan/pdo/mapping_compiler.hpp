#pragma once
#include <optional>
#include <vector>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Compiles the mapping that the network file asks for and checks it against the dictionary. Each
/// error names the correct form if there is one. Entries with errors are left out.
std::vector<EffectiveEntry> compile_mapping(const NodeSource& node, const EffectivePdo& pdo,
                                            const Sourced<std::vector<MappingSpec>>& wanted,
                                            NetworkReport& report);

/// Returns the mapping of the device file unchanged.
std::vector<EffectiveEntry> mapping_of(const NodeSource& node, const PdoDescription& pdo,
                                       SourcePos pos);

/// Returns the name of an object for messages and signals: the name of the object itself for a VAR,
/// else the name of its sub-index.
std::string object_name(const ObjectDictionary& dictionary, ObjectKey key);
/// Returns the key and the name of an object: `6064:00 Position actual value`.
std::string label(const ObjectDictionary& dictionary, ObjectKey key);
/// Returns the end of a sentence about a missing object if its index would be right with 0x; else
/// an empty text.
std::string without_0x(const ObjectDictionary& dictionary, std::uint16_t index);

}  // namespace takt
