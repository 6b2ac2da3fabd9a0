#pragma once
#include <optional>
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/pdo_description.hpp"

namespace takt {

/// The mapping that the network file asks for, checked against the dictionary. Errors are told with
/// what would be right; entries with errors are left out.
std::vector<EffectiveEntry> compile_mapping(const NodeSource& node, const EffectivePdo& pdo,
                                            const Sourced<std::vector<MappingSpec>>& wanted,
                                            NetworkReport& report);

/// The mapping of the device file as it is.
std::vector<EffectiveEntry> mapping_of(const NodeSource& node, const PdoDescription& pdo,
                                       SourcePos pos);

/// Name of an object for messages and signals: of the object itself for a VAR, else of its sub.
std::string object_name(const ObjectDictionary& dictionary, ObjectKey key);
/// `6064:00 Position actual value`.
std::string label(const ObjectDictionary& dictionary, ObjectKey key);
/// The end of a sentence on a missing object whose index would be right with 0x; else empty.
std::string without_0x(const ObjectDictionary& dictionary, std::uint16_t index);

}  // namespace takt
