#pragma once
#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The families of rules that check() runs. Each family is in a separate file.
void check_values(const ObjectDictionary& dictionary, Report& report);
void check_widths(const ObjectDictionary& dictionary, Report& report);
void check_mandatory(const ObjectDictionary& dictionary, Report& report);
void check_identity(const ObjectDictionary& dictionary, Report& report);
void check_profile(const ObjectDictionary& dictionary, Report& report);
void check_pdos(const ObjectDictionary& dictionary, Report& report);
void check_mapping(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report);
void check_cob_ids(const ObjectDictionary& dictionary, Report& report);

/// Returns the name of the section of an object, such as "1A00sub2".
std::string section_name(ObjectKey key);

}  // namespace takt
