#pragma once
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/pdo_description.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// The families of rules that check() runs; one file each.
void check_values(const ObjectDictionary& dictionary, Report& report);
void check_mandatory(const ObjectDictionary& dictionary, Report& report);
void check_identity(const ObjectDictionary& dictionary, Report& report);
void check_profile(const ObjectDictionary& dictionary, Report& report);
void check_pdos(const ObjectDictionary& dictionary, Report& report);
void check_mapping(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report);
void check_cob_ids(const ObjectDictionary& dictionary, Report& report);

/// "TPDO2".
std::string pdo_name(const PdoDescription& pdo);
/// "1A00sub2", as the section is called.
std::string section_name(ObjectKey key);
/// Value of an object as an unsigned number; none where it has no integer value.
std::optional<std::uint64_t> number_of(const ObjectDictionary& dictionary, ObjectKey key);

}  // namespace takt
