#pragma once
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

/// Returns the key and the name of an object: `6064:00 Position actual value`.
std::string label(const ObjectDictionary& dictionary, ObjectKey key);
/// Returns a hint for a message about a missing object whose index may lack the prefix `0x`: the
/// same four digits as a hexadecimal index, for example 0x6064 for the number 6064. The text is
/// empty if the device does not have that object either.
std::string without_0x(const ObjectDictionary& dictionary, std::uint16_t index);

/// Compiles the objects of a multiplexed PDO, as the network file lists them. For a SAM MPDO, and
/// for every MPDO that the master sends, they are objects of the device's dictionary. For a DAM
/// MPDO that the device sends, they are objects of the master itself, and `bits` gives their width.
std::vector<EffectiveEntry> compile_mpdo(const NodeSource& node, const EffectivePdo& pdo,
                                         const Sourced<std::vector<MappingSpec>>& wanted,
                                         NetworkReport& report);

/// Returns bytes 0..3 of the frames that carry this object. For a SAM MPDO that the master sends,
/// they hold the source object that the device's dispatching list assigns to this object. CiA 301,
/// 7.2.3.
std::uint32_t mpdo_header(const NodeSource& node, const EffectivePdo& pdo,
                          const EffectiveEntry& entry, NodeId master);

/// Reports an error if a SAM MPDO of the master carries an object that the device's dispatching
/// list does not contain.
void check_dispatching(const NodeSource& node, const EffectivePdo& pdo, NodeId master,
                       NetworkReport& report);

}  // namespace takt
